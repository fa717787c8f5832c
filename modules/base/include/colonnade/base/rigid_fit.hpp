// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// One point in two frames, metres.
struct PointPair {
  Eigen::Vector2d p_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_b = Eigen::Vector2d::Zero();
  double weight = 1.0;
};

/// The rigid motion T_a_b that lays the points of b onto those of a with the least weighted sum of
/// squared distances (Horn, Journal of the Optical Society of America A 4(4), 1987, in the plane).
/// Needs a positive weight; of points that all lie in one place the turn means nothing.
Pose2 rigidFit(std::span<const PointPair> pairs);

}  // namespace colonnade
