// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "depth_slope_corners.hpp"
#include "depth_slope_segments.hpp"

namespace colonnade::testing {
namespace {

constexpr double kFocal_px = 580.0;
constexpr double kStated = 4e-4;  ///< sigma of a column, as its variance says

/// Columns of a wall with `scale` times the stated variance; each shares a part of its error with
/// the next: moving means of `shared` columns have the correlation that columnNoise looks for.
InverseColumns wall(int count, double scale, int shared, std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> white(static_cast<std::size_t>(count + shared));
  for (double& w : white) w = normal(engine);
  InverseColumns columns;
  for (int i = 0; i < count; ++i) {
    double error = 0.0;
    for (int k = 0; k < shared; ++k) error += white[static_cast<std::size_t>(i + k)];
    error *= kStated * std::sqrt(scale / shared);
    const double s = (i - count / 2) / kFocal_px;
    columns.push_back({s, 0.4 + 0.1 * s + error, kStated * kStated, i, 60});
  }
  return columns;
}

ColumnNoise noiseOf(const InverseColumns& columns) {
  return columnNoise(columns, {InverseLineFits(columns).fit(0, columns.size())});
}

TEST(ColumnNoise, IsWhatTheColumnsScatter) {
  double scale = 0.0, alone = 0.0, sharing = 0.0;
  constexpr int kRuns = 20;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    const auto noise = noiseOf(wall(600, 0.3, 1, seed));
    scale += noise.scale / kRuns;
    alone += noise.shared / kRuns;
    sharing += noiseOf(wall(600, 0.3, 3, seed)).shared / kRuns;
  }
  EXPECT_NEAR(scale, 0.3, 0.06);  // 30 columns of prior knowledge say 1
  EXPECT_NEAR(alone, 1.1, 0.15);
  EXPECT_NEAR(sharing, 3.0, 0.4);  // columns that have one error in common
}

TEST(ColumnNoise, FewColumnsSayTheUsual) {
  const ColumnNoise usual;
  const auto noise = noiseOf(wall(8, 0.01, 1, 1));
  EXPECT_GT(noise.scale, 0.7 * usual.scale);
  EXPECT_GT(noise.shared, 0.7 * usual.shared);
}

/// The mean of squared normalised errors of lines at their ends is 1 with what columnNoise says.
TEST(ColumnNoise, MakesTheErrorsOfLinesHonest) {
  double sum = 0.0;
  constexpr int kRuns = 300;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    const InverseColumns columns = wall(200, 0.3, 3, seed);
    InverseLineFits fits(columns);
    const auto noise = columnNoise(columns, {fits.fit(0, columns.size())});
    fits.assumeScale(noise.scale);
    const auto line = fits.fit(0, 60);
    const double s = columns.front().s;
    const double error = line.at(s) - (0.4 + 0.1 * s);
    sum += error * error / (noise.shared * line.variance(s));
  }
  EXPECT_GT(sum / kRuns, 0.8);
  EXPECT_LT(sum / kRuns, 1.3);
}

}  // namespace
}  // namespace colonnade::testing
