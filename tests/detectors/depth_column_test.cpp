// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_column.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "colonnade/detectors/depth_noise.hpp"
#include "statistics.hpp"

namespace colonnade::testing {
namespace {

/// Median and means in plain words.
ColumnMiddle expected(const std::vector<float>& z, const std::vector<float>& offset) {
  ColumnMiddle middle;
  std::vector<float> sorted = z;
  middle.median = medianOf(sorted);
  const double reach = 3.0 * kinectDepthSigma(static_cast<double>(middle.median));
  double sum = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto depth = static_cast<double>(z[i]);
    if (std::abs(depth - static_cast<double>(middle.median)) > reach) continue;
    sum += 1.0 / depth;
    middle.offset += static_cast<double>(offset[i]);
    ++middle.pixels;
  }
  middle.z = middle.pixels / sum;
  middle.offset /= middle.pixels;
  return middle;
}

ColumnMiddle middleOf(std::vector<float> z, std::vector<float> offset) {
  const int pixels = static_cast<int>(z.size()), blocks = columnBlocks(pixels);
  const auto padded = static_cast<std::size_t>(blocks * kColumnBlock);
  z.resize(padded);
  offset.resize(padded);
  std::vector<double> inverse(padded);
  fillColumnBlock(z.data(), offset.data(), pixels);
  inverseDepths(z.data(), blocks, inverse.data());
  return middleOfColumn(z.data(), inverse.data(), offset.data(), blocks, pixels);
}

void expectSame(const ColumnMiddle& a, const ColumnMiddle& b) {
  EXPECT_EQ(a.median, b.median);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_NEAR(a.z, b.z, 1e-12);
  EXPECT_NEAR(a.offset, b.offset, 1e-9);
}

TEST(DepthColumn, IsWhatSortingGives) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  std::uniform_real_distribution<float> anywhere(0.2F, 15.0F), offsets(-0.5F, 0.5F);
  for (int pixels = 1; pixels < 180; ++pixels) {
    std::vector<float> z, offset;
    for (int i = 0; i < pixels; ++i) {
      const bool outlier = random() % 5 == 0;
      z.push_back(outlier ? anywhere(random) : 3.0F + noise(random));
      // Some in steps of disparity, so that many are equal.
      if (pixels % 3 == 0) z.back() = 1.0F / (std::round(z.back() * 50.0F) / 50.0F);
      offset.push_back(offsets(random));
    }
    expectSame(middleOf(z, offset), expected(z, offset));
  }
}

TEST(DepthColumn, OneValueOnly) {
  for (const std::size_t pixels : {1U, 7U, 8U, 9U, 60U}) {
    const std::vector<float> z(pixels, 1.25F), offset(pixels, 0.25F);
    expectSame(middleOf(z, offset), {1.25, 0.25, 1.25F, static_cast<int>(pixels)});
  }
}

}  // namespace
}  // namespace colonnade::testing
