// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

Pose2 Walker::poseAt(double time_s) const {
  std::vector<Eigen::Vector2d> path = waypoints;
  if (round) {
    path.push_back(path.front());
  } else {
    path.insert(path.end(), waypoints.rbegin() + 1, waypoints.rend());
  }
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  double left = std::fmod(distanceAt(time_s), length);
  if (left < 0.0) left += length;
  std::size_t leg = 1;
  while (leg + 1 < path.size() && left > (path[leg] - path[leg - 1]).norm()) {
    left -= (path[leg] - path[leg - 1]).norm();
    ++leg;
  }
  const Eigen::Vector2d direction = (path[leg] - path[leg - 1]).normalized();
  const Eigen::Vector2d p = path[leg - 1] + left * direction;
  return {p.x(), p.y(), std::atan2(direction.y(), direction.x())};
}

}  // namespace colonnade
