// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "depth_slope_segments.hpp"

namespace colonnade {

/// A circle in the slice: the outline of a round pillar.
struct SliceCircle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
  double cost = 0.0;  ///< chi-squared of the columns, as of straight pieces
};

/// Fits the near side of a circle to columns [first, last): algebraically (Kasa 1976), then Gauss
/// and Newton on the distances. A radius of 0 says that there is none.
SliceCircle fitCircle(const InverseColumns& columns, std::size_t first, std::size_t last);

}  // namespace colonnade
