// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slice_row.hpp"

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {

COLONNADE_VECTOR_KERNEL
void placeRow(const float* depth_m, const RayRow& rays, const SliceGrid& grid,
              const SlicePlaces& places) {
  constexpr double kNearest_m = 0.2, kFarthest_m = 15.0;
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
  const double last = grid.columns - 1.0;
  const std::int32_t bands = grid.bands;
  const int columns = grid.columns;
  for (int u = 0; u < columns; ++u) {
    const double depth = static_cast<double>(depths[u]);
    const double height = camera_height_m + depth * (r.up.first + u * r.up.step);
    const double ahead = r.ahead.first + u * r.ahead.step;
    const double column = middle + focal * (r.right.first + u * r.right.step) / ahead;
    // NaN is in none.
    const bool inside = (depth > kNearest_m) & (depth < kFarthest_m) & (height >= low) &
                        (height < high) & (ahead >= kLeastAhead) & (column > -0.5) &
                        (column < last + 0.5);
    const double known_column = inside ? column : 0.0;
    const double known_height = inside ? height : low;
    const auto index = static_cast<std::int32_t>(known_column + 0.5);
    auto band = static_cast<std::int32_t>((known_height - low) * per_band);
    band = band < bands ? band : bands - 1;
    bins[u] = inside ? index * bands + band : -1;
    zs[u] = static_cast<float>(depth * ahead);
    offsets[u] = static_cast<float>(known_column - index);
  }
}

}  // namespace colonnade
