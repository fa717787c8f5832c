// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/detectors/detector_bank.hpp"
#include "colonnade/edges/edge_options.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// The method of MRPT's program kinect-3d-slam, with the numbers that program has.
struct KinectSlamOptions {
  static constexpr const char* kSection = "KinectSlam";
  int max_features = 150;
  double separation_px = 25.0;
  int window_px = 25;
  double response_to_add = 40.0;
  double response_to_keep = 25.0;
  int check_every = 5;
  bool subpixel = false;
  double max_depth_m = 10.0;
  double keyframe_distance_m = 0.10;
  double keyframe_angle = radians(10.0);
  int reanchor_after = 5;
  bool map = true;
  double map_spacing_m = 0.02;

  void visit(OptionVisitor& v) {
    v.integer("max_features", max_features, {10, 10000}, "corners followed");
    v.number("separation_px", separation_px, {1, 500}, "least distance between new corners");
    v.integer("window_px", window_px, {5, 101}, "of the Lucas-Kanade tracker");
    v.number("response_to_add", response_to_add, {0, 1e4}, "KLT response of a new corner");
    v.number("response_to_keep", response_to_keep, {0, 1e4}, "KLT response of a followed corner");
    v.integer("check_every", check_every, {1, 1000}, "frames between checks of the response");
    v.flag("subpixel", subpixel, "follow corners between pixels; the program does not");
    v.number("max_depth_m", max_depth_m, {0.1, 50}, "farthest depth used");
    v.number("keyframe_distance_m", keyframe_distance_m, {0, 10}, "new key frame after this way");
    v.angle("keyframe_angle_deg", keyframe_angle, {0, 180}, "new key frame after this turn");
    v.integer("reanchor_after", reanchor_after, {0, 100000},
              "frames lost until the last pose becomes a key frame; 0 = never (the program waits "
              "for a person)");
    v.flag("map", map, "build the coloured point map");
    v.number("map_spacing_m", map_spacing_m, {0, 1}, "between neighbouring points of the map");
  }
};

/// mrpt::vision::CDifodo with the numbers of MRPT's program DifOdometry-Datasets.
struct DifodoOptions {
  static constexpr const char* kSection = "Difodo";
  int levels = 5;
  double max_depth_m = 4.5;

  void visit(OptionVisitor& v) {
    v.integer("levels", levels, {1, 5}, "coarse to fine, the finest 320x240");
    v.number("max_depth_m", max_depth_m, {0.5, 50}, "farther depth is not used");
  }
};

/// mrpt::slam::CRangeBearingKFSLAM2D on Colonnade's own detections and motion.
struct KfSlamOptions {
  static constexpr const char* kSection = "KfSlam";
  std::string update = "naive";
  std::string association = "nearest";
  double gate_probability = 0.99;

  void visit(OptionVisitor& v) {
    v.choice("update", update, {"naive", "davison"}, "kfEKFNaive or kfEKFAlaDavison");
    v.choice("association", association, {"nearest", "jcbb"}, "assocNN or assocJCBB");
    v.number("gate_probability", gate_probability, {0.5, 0.999999},
             "share of right measurements the gate lets through");
  }
};

/// Everything a baseline may need.
struct BaselineOptions {
  KinectSlamOptions kinect;
  DifodoOptions difodo;
  KfSlamOptions kf;
  /// Colonnade's own, for those that detect landmarks, measure motion or find the camera's tilt.
  MotionOptions motion;
  EdgeOptions edges;
  DetectorOptions detectors;

  /// The sections baselines have of their own.
  template <class Take>
  void each(Take&& take) {
    take(kinect);
    take(difodo);
    take(kf);
  }
};

}  // namespace colonnade
