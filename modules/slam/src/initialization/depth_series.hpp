// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/slam/initialization_options.hpp"

namespace colonnade {

/// One Gaussian of the sum that stands for the unknown distance along a ray.
struct DepthTerm {
  double distance_m = 0.0;
  double sigma_m = 0.0;
};

/// The geometric series of thesis 2015, eq. (9) (Sola et al. 2005, section III): distances
/// beta^(j-1) s_1 with standard deviations alpha times as large, from s_1 - sigma_1 = nearest on
/// until s_N + sigma_N >= farthest.
std::vector<DepthTerm> depthSeries(const InitializationOptions& options);

/// Shares normalised to a sum of 1; those below prune_share / N are 0 afterwards (thesis 2015,
/// after eq. 11). All zero when the sum is not positive.
void normaliseAndPrune(std::vector<double>& shares, double prune_share);

}  // namespace colonnade
