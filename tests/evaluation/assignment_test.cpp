// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/assignment.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

namespace colonnade {
namespace {

/// The least cost over every way to assign, one estimate after the other.
double leastCost(std::size_t estimates, const std::vector<Candidate>& candidates, double limit,
                 std::size_t truths) {
  std::vector<bool> taken(truths, false);
  const std::function<double(std::size_t)> best = [&](std::size_t i) -> double {
    if (i == estimates) return 0.0;
    double least = limit + best(i + 1);
    for (const auto& c : candidates) {
      if (c.estimate != i || taken[c.truth]) continue;
      taken[c.truth] = true;
      least = std::min(least, c.cost + best(i + 1));
      taken[c.truth] = false;
    }
    return least;
  };
  return best(0);
}

TEST(Assignment, IsOneToOneAndAsCheapAsTheBestOfAll) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    const auto estimates = static_cast<std::size_t>(1 + trial % 6);
    const auto truths = static_cast<std::size_t>(1 + (trial / 6) % 6);
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < estimates; ++i)
      for (std::size_t j = 0; j < truths; ++j)
        if (uniform(random) < 0.6) candidates.push_back({i, j, uniform(random)});
    const auto truth_of = assignOneToOne(estimates, truths, candidates, 1.0);
    double cost = 0.0;
    std::set<std::size_t> used;
    for (std::size_t i = 0; i < estimates; ++i) {
      if (!truth_of[i]) {
        cost += 1.0;
        continue;
      }
      EXPECT_TRUE(used.insert(*truth_of[i]).second);
      double own = 2.0;  // above the limit: no such candidate
      for (const auto& c : candidates)
        if (c.estimate == i && c.truth == *truth_of[i]) own = c.cost;
      cost += own;
    }
    EXPECT_NEAR(cost, leastCost(estimates, candidates, 1.0, truths), 1e-9) << trial;
  }
}

TEST(Assignment, LeavesAloneWhatHasNoCandidate) {
  EXPECT_TRUE(assignOneToOne(0, 3, {}, 1.0).empty());
  const auto truth_of = assignOneToOne(2, 2, {{1, 0, 0.5}}, 1.0);
  EXPECT_FALSE(truth_of[0]);
  EXPECT_EQ(truth_of[1], 0U);
}

}  // namespace
}  // namespace colonnade
