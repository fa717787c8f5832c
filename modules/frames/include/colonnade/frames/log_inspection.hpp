// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/frames/frame_source.hpp"

namespace colonnade {

/// A camera as the first observation of its sensor describes it.
struct CameraSummary {
  int width_px = 0;  ///< of the image itself
  int height_px = 0;
  PinholeCamera calibration;                                         ///< not calibrated: fx = 0
  bool distorted = false;                                            ///< the log gives a lens model
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< optical frame
};

/// A hole in a sensor's stream: more than three times its median period.
struct GapSummary {
  double start_s = 0.0;
  double length_s = 0.0;
};

/// All observations of one class that bear one label.
struct SensorSummary {
  std::string label;
  std::string class_name;  ///< without namespaces
  std::size_t count = 0;
  std::size_t invalid_stamps = 0;
  std::size_t not_growing_stamps = 0;  ///< repeated or going back
  double first_s = 0.0;
  double last_s = 0.0;
  double median_period_s = 0.0;  ///< 0 with fewer than two stamps
  std::size_t gap_count = 0;
  std::vector<GapSummary> longest_gaps;  ///< at most ten, longest first
  std::optional<CameraSummary> colour;
  std::optional<CameraSummary> depth;
  double depth_unit_m = 0.0;  ///< metres per unit, with `depth`
  bool depth_along_axis = true;

  double rate_hz() const { return median_period_s > 0.0 ? 1.0 / median_period_s : 0.0; }
};

/// What a rawlog holds and how it ends.
struct LogInspection {
  std::uint64_t file_bytes = 0;
  std::uint64_t log_bytes = 0;  ///< uncompressed, as far as it was read
  bool compressed = false;
  std::size_t sensory_frames = 0;
  std::size_t action_collections = 0;
  std::size_t loose_observations = 0;  ///< outside of sensory frames
  std::size_t motions = 0;             ///< 2D or 3D movements in actions
  std::vector<SensorSummary> sensors;  ///< by label, then class
  std::optional<double> first_s, last_s;
  Damage damage;

  bool hasOdometry() const;
  /// "pairs", "list", "mixed" or "empty".
  const char* format() const;
};

/// Reads a whole log once. `progress` gets the share read, 0 to 1. Throws Error when the file is no
/// readable rawlog; damage inside it is part of the result.
LogInspection inspectLog(
    const std::filesystem::path& path,
    const std::function<void(double share, std::size_t entries)>& progress = {});

}  // namespace colonnade
