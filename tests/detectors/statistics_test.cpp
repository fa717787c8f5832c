// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "statistics.hpp"

#include <gtest/gtest.h>

#include <random>

namespace colonnade::testing {
namespace {

TEST(Statistics, CountingGivesTheSameMedianAsOrdering) {
  std::mt19937 random(9);
  for (int count = 0; count < 300; ++count) {
    std::vector<int> values;
    for (int i = 0; i < count; ++i) values.push_back(static_cast<int>(random() % 511) - 255);
    const int counted = medianByCounting<-255, 255>(values);
    EXPECT_EQ(counted, medianOf(values));
  }
}

}  // namespace
}  // namespace colonnade::testing
