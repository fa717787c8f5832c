// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Pinhole parameters of a TUM folder, in pixels.
struct TumCalibration {
  double fx_px = 0.0, fy_px = 0.0, cx_px = 0.0, cy_px = 0.0;
  std::optional<double> depth_units_per_metre;
};

/// Reads `key value` lines: fx, fy, cx, cy, optionally depth_units_per_metre; # for comments.
/// Throws Error(kUsage) for anything else.
TumCalibration readTumCalibration(const std::filesystem::path& path);

enum class GroundTruthWorld {
  kGuess,       ///< first-camera when the file says so or the floor is off its z axis, else z-up
  kZUp,         ///< the world's z axis is vertical
  kFirstCamera  ///< the world is a camera (optical); the floor tells what is up
};

struct TumImportOptions {
  std::filesystem::path folder;                 ///< with rgb.txt and depth.txt
  std::filesystem::path log;                    ///< *.rawlog or *.rawlog.gz; gz either way
  std::optional<TumCalibration> calibration;    ///< nothing: calibration.txt in the folder
  std::optional<double> depth_units_per_metre;  ///< nothing: from the calibration, else 5000
  std::optional<double> camera_height_m;        ///< nothing: from the floor in the depth images
  std::optional<double> camera_pitch;           ///< positive looks down
  std::optional<double> camera_roll;            ///< positive lowers the right side
  std::optional<std::filesystem::path> ground_truth;  ///< nothing: groundtruth.txt or reference.tum
  GroundTruthWorld ground_truth_world = GroundTruthWorld::kGuess;
  int gz_level = 4;
  std::function<void(std::size_t done, std::size_t all)> progress;
};

struct TumImportResult {
  std::size_t frames = 0;
  std::size_t colour_without_depth = 0;  ///< no partner within 0.02 s; left out
  std::size_t depth_without_colour = 0;
  std::map<std::string, std::size_t> skipped;  ///< reason -> pairs lost
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  bool mounting_from_floor = false;  ///< any part of it
  double depth_units_per_metre = 0.0;
  std::optional<std::filesystem::path> ground_truth;  ///< the file written
  GroundTruthWorld ground_truth_world = GroundTruthWorld::kGuess;
  std::size_t ground_truth_poses = 0;
};

/// Turns a folder in the layout of the TUM RGB-D benchmark into a rawlog of one
/// CObservation3DRangeScan a pair. Colour JPEGs are kept byte by byte, other images raw; depth
/// values are kept as they are, with rangeUnits = 1 / depth units per metre. Each observation bears
/// the stamp of its colour image. Throws Error; kUsage where an option is missing or wrong.
TumImportResult importTum(const TumImportOptions& options);

}  // namespace colonnade
