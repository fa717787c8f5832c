// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/slam/map_file.hpp"

namespace colonnade {

/// Where a robot starts in a map that is loaded, and what becomes of the map.
struct MapStart {
  bool localize = false;  ///< the map stays as it is, only the pose is estimated
  Pose2 T_world_robot;
  double sigma_m = 0.05;
  double sigma_heading = radians(1.0);

  /// Of (x, y, phi).
  Eigen::Matrix3d covariance() const {
    return Eigen::Vector3d(sigma_m, sigma_m, sigma_heading).cwiseAbs2().asDiagonal();
  }
};

/// A map to go on from, and where in it the robot starts.
struct Resumption : MapStart {
  SavedMap map;
};

}  // namespace colonnade
