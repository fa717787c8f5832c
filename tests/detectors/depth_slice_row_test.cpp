// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slice_row.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "depth_column.hpp"

namespace colonnade::testing {
namespace {

struct Place {
  int bin = -1;
  float z = 0.0F, offset = 0.0F;
};

/// Pixel by pixel, in plain words.
Place expected(float depth_m, int u, const RayRow& rays, const SliceGrid& grid) {
  const auto depth = static_cast<double>(depth_m);
  const double height = grid.camera_height_m + depth * rays.up.at(u);
  const double ahead = rays.ahead.at(u);
  const double column = grid.middle_px + grid.focal_px * rays.right.at(u) / ahead;
  if (!(depth > 0.2 && depth < 15.0) || ahead < 0.1) return {};
  if (!(height >= grid.min_height_m && height < grid.max_height_m)) return {};
  if (!(column > -0.5 && column < grid.columns - 0.5)) return {};
  const int index = static_cast<int>(column + 0.5);
  const double per_band = grid.bands / (grid.max_height_m - grid.min_height_m);
  const int band =
      std::min(static_cast<int>((height - grid.min_height_m) * per_band), grid.bands - 1);
  const int group = index / kColumnsTogether;
  return {(group * grid.bands + band) * kColumnsTogether + index % kColumnsTogether,
          static_cast<float>(depth * ahead), static_cast<float>(column - index)};
}

TEST(DepthSliceRow, EachPixelIsWhereItsRayMeetsTheSlice) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> depths(0.0F, 6.0F);
  std::uniform_real_distribution<double> little(-0.2, 0.2);
  for (int round = 0; round < 300; ++round) {
    const int columns = round % 3 == 0 ? 640 : 1 + static_cast<int>(random() % 90);
    const SliceGrid grid{1.0 + little(random), 0.3, 1.5, 3, columns, 0.5 * columns, 500.0};
    Frame frame;
    frame.camera = {columns, 480, 500.0, 500.0, 0.5 * columns, 240.0};
    const double roll = little(random), pitch = little(random);
    Eigen::Matrix3d R;  // the optical axis ahead
    R << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
    frame.T_robot_camera.linear() =
        Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
        Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix() * R;
    const LevelledCamera camera(frame);
    const RayRow rays(camera, static_cast<double>(random() % 480));
    std::vector<float> row(static_cast<std::size_t>(columns));
    constexpr float kOdd[] = {0.0F,
                              0.2F,
                              15.0F,
                              -1.0F,
                              std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()};
    for (auto& z : row) z = random() % 6 == 0 ? kOdd[random() % 6] : depths(random);

    const std::size_t blocks = row.size() / kPlacedTogether + 1;
    std::vector<std::int32_t> bin(blocks * kPlacedTogether, -2);
    std::vector<float> z(bin.size()), offset(bin.size());
    std::vector<int> placed(blocks);
    const int count = placeRow(row.data(), 0, columns, rays, grid,
                               {bin.data(), z.data(), offset.data(), placed.data()});
    std::vector<bool> seen(row.size(), false);
    for (int block = 0; block < count; ++block)
      for (int i = 0; i < kPlacedTogether; ++i) {
        const auto u = static_cast<std::size_t>(placed[static_cast<std::size_t>(block)] + i);
        if (u >= row.size()) {
          EXPECT_LT(bin[u], 0);
          continue;
        }
        seen[u] = true;
        const Place right = expected(row[u], static_cast<int>(u), rays, grid);
        ASSERT_EQ(bin[u], right.bin) << u << " of " << columns;
        if (right.bin < 0) continue;
        EXPECT_EQ(z[u], right.z);
        EXPECT_EQ(offset[u], right.offset);
      }
    for (std::size_t u = 0; u < row.size(); ++u)
      if (!seen[u]) {
        EXPECT_LT(expected(row[u], static_cast<int>(u), rays, grid).bin, 0);
      }
  }
}

}  // namespace
}  // namespace colonnade::testing
