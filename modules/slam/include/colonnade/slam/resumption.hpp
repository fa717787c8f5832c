// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/slam/map_file.hpp"
#include "colonnade/slam/place_finder.hpp"

namespace colonnade {

/// Where a robot starts in a map that is loaded, and what becomes of the map.
struct MapStart {
  bool localize = false;  ///< the map stays as it is, only the pose is estimated
  Pose2 T_world_robot = {};
  Eigen::Matrix3d covariance = startCovariance(0.05, radians(1.0));  ///< of (x, y, phi)
  /// Nobody knows where: the place is found as these say, and the two above are not used.
  std::optional<PlaceOptions> anywhere = {};

  static Eigen::Matrix3d startCovariance(double sigma_m, double sigma_heading) {
    return Eigen::Vector3d(sigma_m, sigma_m, sigma_heading).cwiseAbs2().asDiagonal();
  }
};

/// A map to go on from, and where in it the robot starts.
struct Resumption : MapStart {
  SavedMap map;
};

}  // namespace colonnade
