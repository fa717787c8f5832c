// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

/// How motion between frames is measured, and how sure that is.
struct MotionOptions {
  static constexpr const char* kSection = "Motion";

  std::string source = "auto";    ///< auto: odometry and visual, whatever a frame has
  std::string mounting = "auto";  ///< auto: per_frame when the first frame has no odometry

  /// Wheel odometry whose log states no covariance: a random walk, so that cutting a way into more
  /// frames does not change the sum. Variances grow with the way and with the turn.
  double odometry_along = 0.02;            ///< m after 1 m
  double odometry_across = 0.01;           ///< m after 1 m
  double odometry_heading = radians(1.5);  ///< rad after 1 m
  double odometry_turn = radians(2.5);     ///< rad after 1 rad
  double odometry_floor_m = 0.0005;        ///< of every increment, even at rest
  double odometry_floor_angle = radians(0.02);
  bool calibrate_wheels = true;  ///< learn their scale, drift and turn from the camera

  /// Visual odometry. direct: own alignment of brightness and surfaces to a key frame. The others
  /// are OpenCV's, frame to frame, with covariance and checks of our own at their result.
  std::string engine = "direct";
  bool use_photometric = true;
  bool use_surfaces = true;
  bool use_floor = true;  ///< where there is no depth and the log knows the mounting
  double floor_turn_per_m = radians(15.0);
  double floor_keyframe_m = 0.3;
  double floor_scale = 0.005;  ///< of ways: height and tilt of the camera
  double keyframe_distance_m = 0.15;
  double keyframe_angle = radians(8.0);
  double keyframe_share = 0.6;  ///< of the key frame's points still compared
  double min_share = 0.3;
  double photometric_correlation = 20.0;
  double surface_correlation = 35.0;
  double model_error = 0.03;  ///< sigma per motion: shutter, synchronisation, calibration
  double weak_direction_ratio = 4.0;
  /// Longer steps from frame to frame are left to the wheels, where there are any.
  double visual_reach_m = 1.0;
  double visual_reach_angle = radians(45.0);
  double max_speed_m_s = 2.0;
  double max_turn_rate = radians(150.0);

  /// The former velocity with this random change of it: all there is when nothing measures, and
  /// without wheels a weak prior of visual odometry.
  double coasting_speed_sigma_m_s = 0.4;
  double coasting_turn_sigma = radians(30.0);  ///< rad/s

  void visit(OptionVisitor& v) {
    v.choice("source", source, {"auto", "odometry", "visual", "constant_velocity"},
             "auto: wheel and visual odometry, fused where a frame has both");
    v.choice("mounting", mounting, {"auto", "fixed", "per_frame"},
             "camera tilt and height: from the log, or from the floor in each frame");
    v.number("odometry_along_m", odometry_along, {0, 1}, "sigma along the way after 1 m");
    v.number("odometry_across_m", odometry_across, {0, 1}, "sigma across the way after 1 m");
    v.angle("odometry_heading_deg", odometry_heading, {0, 90}, "sigma of heading after 1 m");
    v.angle("odometry_turn_deg", odometry_turn, {0, 90}, "sigma of heading after a turn of 1 rad");
    v.number("odometry_floor_m", odometry_floor_m, {1e-6, 1}, "smallest sigma of an increment");
    v.angle("odometry_floor_deg", odometry_floor_angle, {1e-4, 10}, "smallest sigma, heading");
    v.flag("calibrate_wheels", calibrate_wheels,
           "learn from the camera what wheels always get wrong");
    v.choice("engine", engine, {"direct", "opencv", "opencv_icp", "opencv_rgbd_icp"},
             "visual odometry: own direct alignment, or one of OpenCV's");
    v.flag("use_photometric", use_photometric, "compare brightness");
    v.flag("use_surfaces", use_surfaces, "compare surfaces, point to plane");
    v.flag("use_floor", use_floor, "without depth: follow the floor's texture");
    v.number("floor_keyframe_m", floor_keyframe_m, {0, 5}, "its key frame dropped after this way");
    v.angle("floor_turn_deg_per_m", floor_turn_per_m, {0, 1000},
            "sharper turns are left to the wheels, where there are any");
    v.number("floor_scale", floor_scale, {0, 1},
             "sigma of its scale: camera height and tilt; as if drawn anew after each metre");
    v.number("keyframe_distance_m", keyframe_distance_m, {0, 5},
             "key frame dropped after this way");
    v.angle("keyframe_angle_deg", keyframe_angle, {0, 90}, "key frame dropped after this turn");
    v.number("keyframe_share", keyframe_share, {0, 1}, "key frame dropped when less is in view");
    v.number("min_share", min_share, {0, 1}, "an alignment on less of the points is refused");
    v.number("photometric_correlation", photometric_correlation, {1, 1e4},
             "neighbouring brightness residuals that count as one");
    v.number("surface_correlation", surface_correlation, {1, 1e5},
             "neighbouring depth residuals that count as one");
    v.number("model_error", model_error, {0, 1}, "sigma of visual odometry per motion");
    v.number("weak_direction_ratio", weak_direction_ratio, {0, 1e4},
             "surface directions count above this many times what noisy normals feign");
    v.number("visual_reach_m", visual_reach_m, {0, 10},
             "longer steps between frames are left to the wheels, where there are any");
    v.angle("visual_reach_deg", visual_reach_angle, {0, 180}, "the same for turns");
    v.number("max_speed_m_s", max_speed_m_s, {0.01, 100}, "faster is a failed alignment");
    v.angle("max_turn_rate_deg", max_turn_rate, {1, 3600}, "per second; faster is a failure");
    v.number("coasting_speed_sigma_m_s", coasting_speed_sigma_m_s, {0.001, 100},
             "change of speed assumed when nothing measures motion");
    v.angle("coasting_turn_sigma_deg", coasting_turn_sigma, {0.01, 3600},
            "change of turn rate assumed then, per second");
  }
};

}  // namespace colonnade
