// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// A pose of the body in the world at a time: seconds, metres.
struct StampedPose {
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
};

/// Poses in the order of time.
using Trajectory = std::vector<StampedPose>;

/// Reads a TUM file: `stamp tx ty tz qx qy qz qw` a line, # for comments. Throws Error with file
/// and line for a wrong number of fields, a non-number, a zero quaternion or stamps out of order.
Trajectory readTum(const std::filesystem::path& path);

/// Writes a TUM file atomically: stamps with 6 decimals (microseconds), the rest so that it reads
/// back to 1e-9.
void writeTum(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace colonnade
