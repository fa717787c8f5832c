// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ray_row.hpp"

namespace colonnade {

/// A slice between two heights, seen by an upright camera.
struct SliceGrid {
  double camera_height_m = 0.0;
  double min_height_m = 0.0;
  double max_height_m = 0.0;
  int bands = 1;  ///< of equal height
  int columns = 0;
  double middle_px = 0.0;
  double focal_px = 0.0;
};

/// Pixels of a row are looked at in blocks; where none can be in the slice, nothing is done.
constexpr int kPlacedTogether = 16;

/// Where the pixels of a row belong. The bins of kColumnsTogether neighbouring columns follow one
/// another for each band, then those of the next band, then the next columns. There is room for
/// whole blocks.
struct SlicePlaces {
  std::int32_t* bin;  ///< negative: in none
  float* z;           ///< forward, m
  float* offset;      ///< of the ray from the middle of its column, columns
  int* block;         ///< first pixels of the blocks that were placed
};

/// depth_m: of a row of the grid's width, of which the pixels [first, last) are placed; first is
/// where a block begins. Returns the number of blocks placed. The same bits on every machine.
int placeRow(const float* depth_m, int first, int last, const RayRow& rays, const SliceGrid& grid,
             const SlicePlaces& places);

}  // namespace colonnade
