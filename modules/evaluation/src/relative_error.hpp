// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "matching.hpp"

namespace colonnade {

/// Fills path length, relative errors by distance and by time, and the drift at the end.
void scoreRelativeErrors(const std::vector<PosePair>& pairs, const EvaluationOptions& options,
                         TrajectoryScore& score);

}  // namespace colonnade
