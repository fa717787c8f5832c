// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/evaluation/floor_map.hpp"

namespace colonnade {

/// How well the free floor of a map agrees with the true one.
struct FloorScore {
  double resolution_m = 0.0;  ///< of the truth, at which the areas are counted
  double estimate_m2 = 0.0;
  double truth_m2 = 0.0;
  double both_m2 = 0.0;
  double iou = 0.0;        ///< both / (estimate or truth)
  double precision = 0.0;  ///< both / estimate
  double recall = 0.0;     ///< both / truth; a robot sees only a part, so this says how much
};

/// Counts the cells of the truth's grid, continued beyond its border as far as the estimate
/// reaches; a cell of it is free in the estimate when its centre is. T_truth_estimate is the
/// alignment of the trajectory. Throws Error when the two share no free cell.
FloorScore scoreFloor(const FloorMap& estimate, const FloorMap& truth,
                      const Pose2& T_truth_estimate);

}  // namespace colonnade
