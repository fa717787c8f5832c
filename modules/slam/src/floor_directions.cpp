// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/floor_directions.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {

std::vector<WallDirection> floorEdgeDirections(const Detections& detections) {
  std::vector<WallDirection> walls;
  for (const Detection& detection : detections) {
    const Measurement& m = detection.measurement;
    if (!detection.accepted() || detection.kind() != LandmarkKind::kFloorEdge || !m.z.allFinite() ||
        !m.R.allFinite())
      continue;
    // The direction of the normal, which modulo a quarter turn is that of the edge.
    walls.push_back({wrapQuarterTurn(m.z(0)), std::sqrt(m.R(0, 0)),
                     (detection.p_robot_b - detection.p_robot_a).norm(), detection.p_robot_a,
                     detection.p_robot_b});
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const auto& a, const auto& b) { return a.length_m > b.length_m; });
  return walls;
}

}  // namespace colonnade
