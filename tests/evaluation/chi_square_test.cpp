// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "colonnade/base/error.hpp"
#include "colonnade/evaluation/consistency.hpp"

namespace colonnade {
namespace {

TEST(ChiSquareBand, IsTheTabulatedOne) {
  // Two-sided 95 %: the 2.5 % and 97.5 % points of every statistics book.
  EXPECT_NEAR(chiSquareBand(1).low, 0.000982, 1e-6);
  EXPECT_NEAR(chiSquareBand(1).high, 5.024, 1e-3);
  EXPECT_NEAR(chiSquareBand(3).low, 0.2158, 1e-4);
  EXPECT_NEAR(chiSquareBand(3).high, 9.3484, 1e-4);
  // Bar-Shalom's example: 50 runs of two degrees, [74.2, 129.6].
  EXPECT_NEAR(chiSquareBand(100).low, 74.222, 1e-3);
  EXPECT_NEAR(chiSquareBand(100).high, 129.561, 1e-3);
  EXPECT_NEAR(chiSquareBand(2, 0.90).high, 5.9915, 1e-4);
}

TEST(ChiSquareBand, OfManyRunsClosesInOnOne) {
  const Band band = consistencyBand(50, 2);
  EXPECT_NEAR(band.low, 0.74222, 1e-5);
  EXPECT_NEAR(band.high, 1.29561, 1e-5);
  EXPECT_TRUE(band.contains(1.0));
  EXPECT_FALSE(band.contains(1.3));
  // sqrt(2 / (runs dof)) is the deviation of the mean; the band is 1.96 of them for many runs.
  EXPECT_NEAR(consistencyBand(100000, 3).high, 1.0 + 1.96 * std::sqrt(2.0 / 300000.0), 1e-4);
}

TEST(ChiSquareBand, HoldsTheShareItPromises) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  const Band band = consistencyBand(10, 3);
  int inside = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    double sum = 0.0;
    for (int i = 0; i < 30; ++i) sum += std::pow(noise(random), 2);
    inside += band.contains(sum / 30.0) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kTrials, 0.95, 0.015);
}

TEST(ChiSquareBand, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(chiSquareBand(0), Error);
  EXPECT_THROW(consistencyBand(0, 3), Error);
  EXPECT_THROW(chiSquareBand(3, 0.0), Error);
  EXPECT_THROW(chiSquareBand(3, 1.0), Error);
}

}  // namespace
}  // namespace colonnade
