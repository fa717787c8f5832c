// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace colonnade {

std::optional<double> rootMean(double sum_of_squares, double weight) {
  if (weight <= 0.0) return std::nullopt;
  return std::sqrt(sum_of_squares / weight);
}

std::vector<std::optional<std::size_t>> assignSeenFirst(
    std::size_t estimates, std::size_t truths, const std::vector<Candidate>& candidates,
    double limit, const std::function<bool(std::size_t)>& seen) {
  std::vector<Candidate> first;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(first),
               [&](const Candidate& c) { return seen(c.truth); });
  auto truth_of = assignOneToOne(estimates, truths, first, limit);
  std::vector<Candidate> second;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(second),
               [&](const Candidate& c) { return !seen(c.truth) && !truth_of[c.estimate]; });
  const auto rest = assignOneToOne(estimates, truths, second, limit);
  for (std::size_t i = 0; i < estimates; ++i)
    if (!truth_of[i]) truth_of[i] = rest[i];
  return truth_of;
}

}  // namespace colonnade
