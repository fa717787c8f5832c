// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "matching.hpp"

namespace colonnade {

/// Fills what TrajectoryScore says of NEES, and its anchor.
void scoreConsistency(const std::vector<PosePair>& pairs,
                      const std::vector<StampedCovariance>& covariances, TrajectoryScore& score);

}  // namespace colonnade
