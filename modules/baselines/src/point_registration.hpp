// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace colonnade {

/// One point seen from two places.
struct PointPair {
  Eigen::Vector3d p_a;
  Eigen::Vector3d p_b;
};

/// T_a_b by mrpt::tfest::se3_l2_robust as kinect-3d-slam calls it (smallest set 3, six inliers are
/// enough, everything else MRPT's default), or nothing when it finds no such motion or its scale
/// is off by 0.1 or more.
std::optional<Eigen::Isometry3d> registerPoints(const std::vector<PointPair>& pairs);

}  // namespace colonnade
