// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "matching.hpp"

namespace colonnade {

/// The rigid motion that brings the estimate's positions nearest to the true ones. Positions alone
/// leave a rotation open when they stand in one point (or, in space, on one line); orientations
/// decide that, with so little weight that they decide nothing else.
Eigen::Isometry3d fitAlignment(const std::vector<PosePair>& pairs, Alignment alignment);

}  // namespace colonnade
