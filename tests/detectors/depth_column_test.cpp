// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_column.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "colonnade/detectors/depth_noise.hpp"
#include "statistics.hpp"

namespace colonnade::testing {
namespace {

struct Middle {
  double z = 0.0, offset = 0.0;
  float median = 0.0F;
  int pixels = 0;
};

struct Column {
  std::vector<float> z, offset;
};
using Columns = std::array<Column, kColumnsTogether>;

/// Median and means in plain words; sums in the order that is promised.
Middle expected(const std::vector<Column>& parts) {
  Middle middle;
  std::vector<float> sorted;
  for (const Column& part : parts) sorted.insert(sorted.end(), part.z.begin(), part.z.end());
  middle.median = medianOf(sorted);
  const double reach = 3.0 * kinectDepthSigma(static_cast<double>(middle.median));
  std::array<double, 4> sums{}, offsets{};
  for (const Column& part : parts)
    for (std::size_t i = 0; i < part.z.size(); ++i) {
      const auto depth = static_cast<double>(part.z[i]);
      if (std::abs(depth - static_cast<double>(middle.median)) > reach) continue;
      sums[i % 4] += 1.0 / depth;
      offsets[i % 4] += static_cast<double>(part.offset[i]);
      ++middle.pixels;
    }
  middle.z = middle.pixels / ((sums[0] + sums[1]) + (sums[2] + sums[3]));
  middle.offset = ((offsets[0] + offsets[1]) + (offsets[2] + offsets[3])) / middle.pixels;
  return middle;
}

/// Columns in slots.
struct Slots {
  ColumnCounts pixels;
  std::vector<DepthSlot> slots;
  std::vector<InverseSlot> inverse;

  explicit Slots(const Columns& columns) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      pixels[c] = static_cast<int>(columns[c].z.size());
    const int count = slotsOf(pixels);
    slots.resize(static_cast<std::size_t>(count));
    inverse.resize(slots.size());
    for (std::size_t c = 0; c < columns.size(); ++c)
      for (std::size_t i = 0; i < columns[c].z.size(); ++i) {
        slots[i].z[c] = columns[c].z[i];
        slots[i].offset[c] = columns[c].offset[i];
      }
    fillSlots(slots.data(), count, pixels);
    inverseDepths(slots.data(), count, inverse.data());
  }
  ColumnPart part() const { return {slots.data(), inverse.data(), static_cast<int>(slots.size())}; }
};

/// Bit for bit.
void expectSame(const ColumnMiddles& found, std::size_t column, const Middle& right) {
  EXPECT_EQ(found.pixels[column], right.pixels);
  if (right.pixels == 0) return;
  EXPECT_EQ(found.median[column], right.median);
  EXPECT_EQ(found.z[column], right.z);
  EXPECT_EQ(found.offset[column], right.offset);
}

Column randomColumn(std::mt19937& random, std::size_t pixels) {
  std::normal_distribution<float> noise(0.0F, 0.02F);
  std::uniform_real_distribution<float> anywhere(0.2F, 15.0F), offsets(-0.5F, 0.5F);
  Column column;
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool outlier = random() % 5 == 0;
    column.z.push_back(outlier ? anywhere(random) : 3.0F + noise(random));
    // Some in steps of disparity, so that many are equal.
    if (pixels % 3 == 0) column.z.back() = 1.0F / (std::round(column.z.back() * 50.0F) / 50.0F);
    column.offset.push_back(offsets(random));
  }
  return column;
}

TEST(DepthColumn, IsWhatSortingGives) {
  std::mt19937 random(3);
  for (std::size_t most = 1; most < 180; ++most) {
    Columns columns;
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c] = randomColumn(random, c == 0 ? most : random() % (most + 1));
    const Slots slots(columns);
    const ColumnPart part = slots.part();
    const ColumnMiddles found = middlesOfColumns({&part, 1}, slots.pixels);
    for (std::size_t c = 0; c < columns.size(); ++c) expectSame(found, c, expected({columns[c]}));
  }
}

TEST(DepthColumn, PartsTogether) {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    Columns low, high;
    for (auto* columns : {&low, &high})
      for (auto& column : *columns) column = randomColumn(random, random() % 40);
    const Slots a(low), b(high);
    const std::array parts{a.part(), b.part()};
    ColumnCounts pixels;
    std::array<float, kColumnsTogether> least, most;
    const ColumnMiddles of_a = middlesOfColumns({&parts[0], 1}, a.pixels);
    const ColumnMiddles of_b = middlesOfColumns({&parts[1], 1}, b.pixels);
    for (std::size_t c = 0; c < pixels.size(); ++c) {
      pixels[c] = a.pixels[c] + b.pixels[c];
      const float first = a.pixels[c] > 0 ? of_a.median[c] : of_b.median[c];
      const float second = b.pixels[c] > 0 ? of_b.median[c] : first;
      least[c] = std::min(first, second);
      most[c] = std::max(first, second);
    }
    const ColumnMiddles found = middlesOfColumns(parts, pixels);
    const ColumnMiddles bounded = middlesOfColumns(parts, pixels, least, most);
    for (std::size_t c = 0; c < pixels.size(); ++c) {
      const Middle right = expected({low[c], high[c]});
      expectSame(found, c, right);
      expectSame(bounded, c, right);
    }
  }
}

TEST(DepthColumn, OneValueOnly) {
  for (const std::size_t pixels : {1U, 7U, 8U, 9U, 60U}) {
    Columns columns;
    columns[5] = {std::vector<float>(pixels, 1.25F), std::vector<float>(pixels, 0.25F)};
    const Slots slots(columns);
    const ColumnPart part = slots.part();
    const ColumnMiddles found = middlesOfColumns({&part, 1}, slots.pixels);
    expectSame(found, 5, expected({columns[5]}));
    expectSame(found, 4, {});
  }
}

}  // namespace
}  // namespace colonnade::testing
