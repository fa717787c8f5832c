// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "colonnade/base/rigid_fit.hpp"

namespace colonnade {

/// The rigid motion that takes anchors of the world, weighed by how often they were seen, from
/// where they are now (b) back to where they were (a). Nothing when they did not move as one: fewer
/// than four of them, all within a metre, or a motion that leaves much of the change unexplained.
std::optional<Pose2> motionOfMap(std::span<const PointPair> anchors);

}  // namespace colonnade
