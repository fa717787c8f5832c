// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slice_row.hpp"

#include <algorithm>
#include <bit>

#include "colonnade/base/vector_kernel.hpp"
#include "depth_column.hpp"
#include "lanes.hpp"

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

constexpr int kLanes = 4;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Doubles = double __attribute__((vector_size(8 * kLanes)));
using Longs = std::int64_t __attribute__((vector_size(8 * kLanes)));

/// The pixels u to u + 3. All conditions stay masks as wide as the numbers they come from.
inline __attribute__((always_inline)) void placeFour(const float* depths, int u, const RayRow& rays,
                                                     const SliceGrid& grid, double per_band,
                                                     const SlicePlaces& places) {
  constexpr double kLeastAhead = 0.1;
  Floats floats;
  load(floats, depths);
  const Doubles depth = __builtin_convertvector(floats, Doubles);
  const Doubles at = static_cast<double>(u) + Doubles{0.0, 1.0, 2.0, 3.0};
  const double low = grid.min_height_m;
  const Doubles height = grid.camera_height_m + depth * (rays.up.first + at * rays.up.step);
  const Doubles ahead = rays.ahead.first + at * rays.ahead.step;
  const Doubles column =
      grid.middle_px + grid.focal_px * (rays.right.first + at * rays.right.step) / ahead;
  // NaN is in none.
  const Longs inside = (depth > kNearest_m) & (depth < kFarthest_m) & (height >= low) &
                       (height < grid.max_height_m) & (ahead >= kLeastAhead) & (column > -0.5) &
                       (column < grid.columns - 0.5);
  const Doubles known_column = inside ? column : Doubles{};
  const Doubles known_height = inside ? height : low - Doubles{};
  const Ints index = __builtin_convertvector(known_column + 0.5, Ints);
  Ints band = __builtin_convertvector((known_height - low) * per_band, Ints);
  const Ints last_band = grid.bands - 1 - Ints{};
  band = band < last_band ? band : last_band;
  const Ints beside = index & (kColumnsTogether - 1);
  const Ints bin = (index - beside) * grid.bands + band * kColumnsTogether + beside;
  store(bin | ~__builtin_convertvector(inside, Ints), places.bin + u);
  store(__builtin_convertvector(depth * ahead, Floats), places.z + u);
  store(__builtin_convertvector(known_column - __builtin_convertvector(index, Doubles), Floats),
        places.offset + u);
}

}  // namespace

COLONNADE_VECTOR_KERNEL
int placeRow(const float* depth_m, int first, int last, const RayRow& rays, const SliceGrid& grid,
             const SlicePlaces& places) {
  static_assert(kPlacedTogether % kLanes == 0 && std::has_single_bit(unsigned{kColumnsTogether}));
  const RayRow row = rays;
  const SliceGrid slice = grid;
  const double per_band = slice.bands / (slice.max_height_m - slice.min_height_m);
  const DepthRange range = depthsWithin(row, slice);
  int blocks = 0;
  for (int begin = first; begin < last; begin += kPlacedTogether) {
    const float* depths = depth_m + begin;
    float filled[kPlacedTogether] = {};
    if (last - begin < kPlacedTogether) {
      std::copy(depths, depth_m + last, filled);
      depths = filled;
    }
    int any = 0;
    for (int i = 0; i < kPlacedTogether; ++i)
      any |= (depths[i] > range.least) & (depths[i] < range.most) ? 1 : 0;
    if (any == 0) continue;
    places.block[blocks++] = begin;
    for (int i = 0; i < kPlacedTogether; i += kLanes)
      placeFour(depths + i, begin + i, row, slice, per_band, places);
  }
  return blocks;
}

}  // namespace colonnade
