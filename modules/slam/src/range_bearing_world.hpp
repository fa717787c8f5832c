// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// A landmark as an anchor of the world: its place, and how often it was seen.
struct WorldAnchor {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double weight = 0.0;
};

/// The rigid motion that takes the anchors from where they are now back to where they were, in the
/// least squares, weighted (Horn 1987, in the plane). Nothing when they did not move as one: fewer
/// than four of them, all within a metre, or a motion that leaves much of the change unexplained.
/// Both lists hold the same anchors in the same order.
std::optional<Pose2> motionOfMap(const std::vector<WorldAnchor>& before,
                                 const std::vector<WorldAnchor>& after);

}  // namespace colonnade
