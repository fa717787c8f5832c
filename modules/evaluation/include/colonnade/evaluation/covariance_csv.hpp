// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// Covariance of a planar pose (x, y, phi) in the axes of the trajectory's world, metres and
/// radians. It is about the pose in the world as it was at the start.
struct StampedCovariance {
  double stamp_s = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Where the world as it was at the start lies by then in that of the trajectory: elsewhere when
  /// the world moved along with the map (RangeBearing.world_with_map).
  Pose2 T_world_origin = {};
};

/// trajectory_covariance.csv: stamp,xx,xy,xphi,yy,yphi,phiphi,origin_x,origin_y,origin_phi; without
/// the last three columns the world never moved. Written atomically; reading throws Error with file
/// and line.
void writeCovarianceCsv(const std::filesystem::path& path,
                        const std::vector<StampedCovariance>& covariances);
std::vector<StampedCovariance> readCovarianceCsv(const std::filesystem::path& path);

}  // namespace colonnade
