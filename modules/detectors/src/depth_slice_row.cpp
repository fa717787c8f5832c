// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slice_row.hpp"

#include <algorithm>

#include "colonnade/base/vector_kernel.hpp"
#include "depth_column.hpp"

namespace colonnade {

namespace {

constexpr double kNearest_m = 0.2, kFarthest_m = 15.0;

struct DepthRange {
  float least, most;
};
/// Depths that a row may have within the slice, and some more.
DepthRange depthsWithin(const RayRow& rays, const SliceGrid& grid) {
  const double a = rays.up.at(0.0), b = rays.up.at(grid.columns - 1.0);
  const double low = std::min(a, b), high = std::max(a, b);
  // From the camera to the upper and lower end of the slice.
  const double to_top = grid.max_height_m - grid.camera_height_m;
  const double to_bottom = grid.min_height_m - grid.camera_height_m;
  double least = kNearest_m, most = kFarthest_m;
  if (low > 0.0) {
    most = std::min(most, to_top / low);
    least = std::max(least, to_bottom / high);
  } else if (high < 0.0) {
    most = std::min(most, to_bottom / high);
    least = std::max(least, to_top / low);
  }
  constexpr double kRounding = 1e-5;
  return {static_cast<float>(least * (1.0 - kRounding)),
          static_cast<float>(most * (1.0 + kRounding))};
}

}  // namespace

COLONNADE_VECTOR_KERNEL
int placeRow(const float* depth_m, int first, int last, const RayRow& rays, const SliceGrid& grid,
             const SlicePlaces& places) {
  constexpr double kLeastAhead = 0.1;
  const float* __restrict depths = depth_m;
  std::int32_t* __restrict bins = places.bin;
  float* __restrict zs = places.z;
  float* __restrict offsets = places.offset;
  const RayRow r = rays;
  const double camera_height_m = grid.camera_height_m;
  const double low = grid.min_height_m, high = grid.max_height_m;
  const double per_band = grid.bands / (high - low);
  const double middle = grid.middle_px, focal = grid.focal_px;
  const double last_column = grid.columns - 1.0;
  const std::int32_t bands = grid.bands;
  const DepthRange range = depthsWithin(rays, grid);
  int blocks = 0;
  for (int begin = first; begin < last; begin += kPlacedTogether) {
    const int end = std::min(begin + kPlacedTogether, last);
    int any = 0;
    for (int u = begin; u < end; ++u)
      any |= (depths[u] > range.least) & (depths[u] < range.most) ? 1 : 0;
    if (any == 0) continue;
    places.block[blocks++] = begin;
    for (int u = begin; u < end; ++u) {
      const double depth = static_cast<double>(depths[u]);
      const double height = camera_height_m + depth * (r.up.first + u * r.up.step);
      const double ahead = r.ahead.first + u * r.ahead.step;
      const double column = middle + focal * (r.right.first + u * r.right.step) / ahead;
      // NaN is in none.
      const bool inside = (depth > kNearest_m) & (depth < kFarthest_m) & (height >= low) &
                          (height < high) & (ahead >= kLeastAhead) & (column > -0.5) &
                          (column < last_column + 0.5);
      const double known_column = inside ? column : 0.0;
      const double known_height = inside ? height : low;
      const auto index = static_cast<std::int32_t>(known_column + 0.5);
      auto band = static_cast<std::int32_t>((known_height - low) * per_band);
      band = band < bands ? band : bands - 1;
      const std::int32_t beside = index % kColumnsTogether;
      bins[u] = inside ? (index - beside) * bands + band * kColumnsTogether + beside : -1;
      zs[u] = static_cast<float>(depth * ahead);
      offsets[u] = static_cast<float>(known_column - index);
    }
  }
  return blocks;
}

}  // namespace colonnade
