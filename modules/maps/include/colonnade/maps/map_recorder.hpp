// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/maps/levelled_scan.hpp"
#include "colonnade/maps/map_picture.hpp"

namespace colonnade {

struct MapOptions {
  static constexpr const char* kSection = "Maps";
  double keyframe_distance_m = 0.25;
  double keyframe_turn = radians(10.0);
  double grid_resolution_m = 0.05;

  void visit(OptionVisitor& v) {
    v.number("keyframe_distance_m", keyframe_distance_m, {0.01, 10}, "between kept scans");
    v.angle("keyframe_turn_deg", keyframe_turn, {0.5, 180}, "between kept scans");
    v.number("grid_resolution_m", grid_resolution_m, {0.01, 1}, "cell size of the grid map");
  }
};

/// What the maps are made of when the run is over.
struct MapContents {
  std::string title;
  LandmarkMap landmarks;
  /// As it stands after the last loop closing: key frames move to it. Empty: they stay where they
  /// were added.
  Trajectory trajectory;
  Trajectory ground_truth;  ///< only for the picture; in the map's world
};

/// What finish() wrote, and what it left out and why (one line each).
struct MapFiles {
  std::vector<std::filesystem::path> written;
  std::vector<std::string> left_out;
};

/// Collects scans while the robot drives and writes the maps that MRPT's own programs open. Scans
/// of key frames stay in memory, about 1 kB each; scans.rawlog grows on the disk under a temporary
/// name that disappears with the recorder unless finish() is reached.
class MapRecorder {
 public:
  MapRecorder(const std::filesystem::path& folder, const MapOptions& map_options,
              const ScanOptions& scan_options);
  ~MapRecorder();
  MapRecorder(const MapRecorder&) = delete;
  MapRecorder& operator=(const MapRecorder&) = delete;

  /// One frame: where the filter believes the robot to be, with the covariance of (x, y, phi) in
  /// the world's axes, and the motion since the former frame that the filter used, with its
  /// covariance in the former robot's axes. A frame without depth only adds to the motion.
  void add(const Frame& frame, const Pose2& T_world_robot, const Eigen::Matrix3d& covariance,
           const Pose2& T_previous_robot, const Eigen::Matrix3d& increment_covariance);

  /// Writes scans.rawlog, map.simplemap, map.gridmap.gz, map.png, map.yaml, map.landmarksmap.gz,
  /// map.metricmap.gz, map.3Dscene and map_overview.png, each atomically. Without any scan the
  /// first five are left out and named in the result. Throws Error when a file cannot be written.
  MapFiles finish(const MapContents& contents);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
