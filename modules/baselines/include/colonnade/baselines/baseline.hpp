// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/baselines/baseline_options.hpp"
#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// What a baseline says after one frame.
struct BaselineStep {
  /// World: the robot at the first frame. A lost frame keeps the last pose.
  Pose2 T_world_robot;
  std::string lost;     ///< why this frame gave no pose of its own; empty: it did
  double map_ms = 0.0;  ///< of the time spent, what went into a map the method never reads
};

/// A method MRPT ships, fed with the frames Colonnade gets: the same images, depth, calibration,
/// mounting and odometry. Its pose is the robot's on the floor: a camera path in space is reduced
/// to the camera's place and the projection of its optical axis.
class Baseline {
 public:
  virtual ~Baseline() = default;
  /// Frames in the order of time. Throws Error when the log cannot be used at all.
  virtual BaselineStep step(const Frame& frame) = 0;
  /// Landmarks so far; empty for methods without.
  virtual LandmarkMap landmarks() const { return {}; }
  /// What the method counts besides, by name: key frames, points in the map ...
  virtual std::map<std::string, double> figures() const { return {}; }
  /// Writes the method's own map files into a folder, if it has any, each atomically.
  virtual void writeMap(const std::filesystem::path& /*folder*/) const {}
};

/// kinect-3d-slam, difodo, kf-slam, dead-reckoning.
const std::vector<std::string>& baselineNames();

/// Throws Error (kUsage) for another name. Deterministic but for kinect-3d-slam, whose random
/// samples MRPT draws from the machine's entropy (se3_l2_robust cannot be seeded in 2.5.8): repeat
/// it.
std::unique_ptr<Baseline> makeBaseline(const std::string& name, const BaselineOptions& options);

}  // namespace colonnade
