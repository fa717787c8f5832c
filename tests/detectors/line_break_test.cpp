// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_break.hpp"

#include <gtest/gtest.h>

#include <random>

namespace colonnade::testing {
namespace {

double costOf(SampleSpan samples) {
  return sumOfSquaredResiduals(samples, leastSquares(samples)->line);
}

/// The place where two fitted lines leave least, by fitting them at every place.
std::size_t expectedPlace(SampleSpan samples) {
  std::size_t best = 10;
  double least = 1e300;
  for (std::size_t i = 10; i + 10 <= samples.size(); ++i) {
    const double cost = costOf(samples.first(i)) + costOf(samples.subspan(i));
    if (cost >= least) continue;
    least = cost;
    best = i;
  }
  return best;
}

TEST(LineBreak, IsWhereTwoFittedLinesLeaveLeast) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.15);
  int broken = 0;
  for (int round = 0; round < 100; ++round) {
    const int count = 40 + static_cast<int>(random() % 300);
    const int bend = 15 + static_cast<int>(random() % static_cast<unsigned>(count - 30));
    Samples samples(count);
    for (int i = 0; i < count; ++i) {
      samples.add(i, 0);
      samples.across()[i] =
          100.0 + 0.3 * i + noise(random) + (round % 4 == 0 || i < bend ? 0.0 : 4.0);
    }
    const auto place = breakOf(samples, 4.0);
    EXPECT_FALSE(place && round % 4 == 0) << "a straight line";
    if (!place) continue;
    ++broken;
    EXPECT_EQ(*place, expectedPlace(samples));
  }
  EXPECT_GT(broken, 60);
}

TEST(LineBreak, NeedsSamplesOnBothSides) {
  for (const int count : {0, 1, 19}) {
    Samples samples(count);
    for (int i = 0; i < count; ++i) samples.add(i, i < 10 ? 0 : 50);
    for (int i = 0; i < count; ++i) samples.across()[i] = i < 10 ? 0.0 : 50.0;
    EXPECT_FALSE(breakOf(samples, 4.0));
  }
}

}  // namespace
}  // namespace colonnade::testing
