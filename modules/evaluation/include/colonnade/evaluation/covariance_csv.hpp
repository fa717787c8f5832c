// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace colonnade {

/// Covariance of a planar pose (x, y, phi) in the world's axes: metres and radians.
struct StampedCovariance {
  double stamp_s = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// trajectory_covariance.csv: stamp,xx,xy,xphi,yy,yphi,phiphi. Written atomically; reading throws
/// Error with file and line.
void writeCovarianceCsv(const std::filesystem::path& path,
                        const std::vector<StampedCovariance>& covariances);
std::vector<StampedCovariance> readCovarianceCsv(const std::filesystem::path& path);

}  // namespace colonnade
