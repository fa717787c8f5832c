// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace colonnade {

/// A straight line in the depth slice by total least squares.
struct SliceLine {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< unit, towards growing x
  double rms_m = 0.0;                                ///< of the points across the line
  double spread_m2 = 0.0;                            ///< sum of squares along the line
  int points = 0;
};

SliceLine fitSliceLine(const std::vector<Eigen::Vector2d>& points);

}  // namespace colonnade
