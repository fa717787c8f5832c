// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_cells.hpp"

#include <algorithm>
#include <limits>

namespace colonnade {
namespace {

constexpr int kCellsInRow = 80;
constexpr float kNearest_m = 0.2F;
constexpr float kFarthest_m = 15.0F;
constexpr int kValidAround = 6;  ///< of nine cells

/// Looks at no more than 4 x 4 pixels of the cell.
float nearestIn(const cv::Mat& depth_m, int left, int top, int size) {
  const int step = (size + 3) / 4;
  float nearest = std::numeric_limits<float>::max();
  int seen = 0;
  int valid = 0;
  for (int v = top + step / 2; v < top + size; v += step) {
    const float* row = depth_m.ptr<float>(v);
    for (int u = left + step / 2; u < left + size; u += step) {
      const float z = row[u];
      const bool measured = z > kNearest_m && z < kFarthest_m;  // not NaN
      nearest = measured ? std::min(nearest, z) : nearest;
      valid += measured ? 1 : 0;
      ++seen;
    }
  }
  return 4 * valid >= seen && valid > 0 ? nearest : DepthCells::kNone;
}

float nearestAround(const DepthCells& cells, int column, int row) {
  float nearest = std::numeric_limits<float>::max();
  int valid = 0;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      if (!cells.contains(c, r)) continue;
      const float z = cells.near_m[cells.index(c, r)];
      if (z == DepthCells::kNone) continue;
      ++valid;
      nearest = std::min(nearest, z);
    }
  }
  return valid >= kValidAround ? nearest : DepthCells::kNone;
}

}  // namespace

DepthCells makeDepthCells(const Frame& frame) {
  DepthCells cells;
  const cv::Mat& depth_m = frame.depth_m;
  if (depth_m.empty() || depth_m.type() != CV_32FC1) return cells;
  if (!frame.gray.empty() && depth_m.size() != frame.gray.size()) return cells;
  cells.cell_px = std::max(1, depth_m.cols / kCellsInRow);
  cells.columns = depth_m.cols / cells.cell_px;
  cells.rows = depth_m.rows / cells.cell_px;
  cells.camera = frame.camera;
  const std::size_t count =
      static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows);
  cells.near_m.resize(count);
  cells.around_m.resize(count);
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      cells.near_m[cells.index(column, row)] =
          nearestIn(depth_m, column * cells.cell_px, row * cells.cell_px, cells.cell_px);
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      cells.around_m[cells.index(column, row)] = nearestAround(cells, column, row);
  return cells;
}

}  // namespace colonnade
