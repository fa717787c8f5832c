// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/observation.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

Sight sightOf(const DepthProfile& profile) {
  Sight sight;
  sight.p_robot_camera = profile.p_robot_camera;
  sight.rays.reserve(profile.columns.size());
  for (const DepthProfile::Column& column : profile.columns) {
    const Eigen::Vector2d ray = profile.R_robot_slice * Eigen::Vector2d(column.slope, 1.0);
    sight.rays.push_back({std::atan2(ray.y(), ray.x()), column.z * ray.norm()});
  }
  std::reverse(sight.rays.begin(), sight.rays.end());  // left to right is clockwise
  return sight;
}

}  // namespace colonnade
