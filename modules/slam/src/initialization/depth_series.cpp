// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_series.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace colonnade {

std::vector<DepthTerm> depthSeries(const InitializationOptions& options) {
  const double alpha = options.depth_ratio;
  std::vector<DepthTerm> series;
  double distance = options.nearest_m / (1.0 - alpha);
  series.push_back({distance, alpha * distance});
  while (distance * (1.0 + alpha) < options.farthest_m) {
    distance *= options.depth_step;
    series.push_back({distance, alpha * distance});
  }
  return series;
}

void normaliseAndPrune(std::vector<double>& shares, double prune_share) {
  const auto normalise = [&] {
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    const bool usable = std::isfinite(sum) && sum > 0.0;
    for (double& share : shares) share = usable ? share / sum : 0.0;
  };
  normalise();
  const auto left = std::count_if(shares.begin(), shares.end(), [](double s) { return s > 0.0; });
  for (double& share : shares)
    if (share < prune_share / static_cast<double>(left)) share = 0.0;
  normalise();
}

}  // namespace colonnade
