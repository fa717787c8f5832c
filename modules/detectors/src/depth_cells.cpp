// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_cells.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

constexpr int kCellsInRow = 80;
constexpr float kNearest_m = 0.2F;
constexpr float kFarthest_m = 15.0F;
constexpr float kAbsent = std::numeric_limits<float>::max();  ///< farther than all
constexpr int kValidAround = 6;                               ///< of nine cells

constexpr int kLookedAt = 4;  ///< rows and columns of a cell

/// Of a few rows, the nearest depth in every column and how many have any.
COLONNADE_VECTOR_KERNEL
void gatherRows(const float* const rows[kLookedAt], int count, int columns, float* nearest,
                std::int32_t* valid) {
  float* __restrict near = nearest;
  std::int32_t* __restrict measured_rows = valid;
  for (int u = 0; u < columns; ++u) {
    near[u] = kAbsent;
    measured_rows[u] = 0;
  }
  for (int i = 0; i < count; ++i) {
    const float* __restrict row = rows[i];
    for (int u = 0; u < columns; ++u) {
      const float z = row[u];
      const bool measured = (z > kNearest_m) & (z < kFarthest_m);  // not NaN
      const float known = measured ? z : kAbsent;
      near[u] = known < near[u] ? known : near[u];
      measured_rows[u] += measured ? 1 : 0;
    }
  }
}

/// The cells are the first to read a depth image, a few of its rows each: too far apart for the
/// processor to foresee them.
void prefetchRow(const cv::Mat& depth_m, int row) {
  if (row >= depth_m.rows) return;
  constexpr int kCacheLine = 64 / sizeof(float);
  const auto* const depths = depth_m.ptr<float>(row);
  for (int u = 0; u < depth_m.cols; u += kCacheLine) __builtin_prefetch(depths + u);
}

/// Fills near_m; looks at no more than 4 x 4 pixels of each cell.
void findNearest(const cv::Mat& depth_m, DepthCells& cells) {
  const int step = (cells.cell_px + kLookedAt - 1) / kLookedAt;
  std::vector<float> nearest(static_cast<std::size_t>(depth_m.cols));
  std::vector<std::int32_t> valid(nearest.size());
  for (int row = 0; row < cells.rows; ++row) {
    const float* rows[kLookedAt];
    int count = 0;
    for (int v = step / 2; v < cells.cell_px; v += step)
      rows[count++] = depth_m.ptr<float>(row * cells.cell_px + v);
    for (int v = step / 2; v < cells.cell_px; v += step)
      prefetchRow(depth_m, (row + 1) * cells.cell_px + v);
    gatherRows(rows, count, depth_m.cols, nearest.data(), valid.data());
    for (int column = 0; column < cells.columns; ++column) {
      float near = kAbsent;
      int measured = 0, columns = 0;
      for (int u = step / 2; u < cells.cell_px; u += step, ++columns) {
        const auto at = static_cast<std::size_t>(column * cells.cell_px + u);
        near = std::min(near, nearest[at]);
        measured += valid[at];
      }
      if (4 * measured >= columns * count && measured > 0)
        cells.near_m[cells.index(column, row)] = near;
    }
  }
}

/// Of three neighbouring rows, nearest[i] in columns i to i + 2; none where few have depth.
COLONNADE_VECTOR_KERNEL
void nearestOfNine(const float* const rows[3], int columns, float* nearest) {
  float* __restrict out = nearest;
  const float* __restrict a = rows[0];
  const float* __restrict b = rows[1];
  const float* __restrict c = rows[2];
  const auto least = [](float x, float y) { return x < y ? x : y; };
  const auto known = [](float x) { return x < kAbsent ? 1 : 0; };
  for (int i = 0; i < columns; ++i) {
    const float left = least(a[i], least(b[i], c[i]));
    const float middle = least(a[i + 1], least(b[i + 1], c[i + 1]));
    const float right = least(a[i + 2], least(b[i + 2], c[i + 2]));
    const int valid = known(a[i]) + known(b[i]) + known(c[i]) + known(a[i + 1]) + known(b[i + 1]) +
                      known(c[i + 1]) + known(a[i + 2]) + known(b[i + 2]) + known(c[i + 2]);
    out[i] = valid >= kValidAround ? least(left, least(middle, right)) : DepthCells::kNone;
  }
}

/// Fills around_m.
void findNearestAround(DepthCells& cells) {
  // With a border of cells without depth.
  const auto width = static_cast<std::size_t>(cells.columns) + 2;
  std::vector<float> padded(width * (static_cast<std::size_t>(cells.rows) + 2), kAbsent);
  for (int row = 0; row < cells.rows; ++row)
    std::replace_copy_if(
        &cells.near_m[cells.index(0, row)], &cells.near_m[cells.index(0, row)] + cells.columns,
        &padded[(static_cast<std::size_t>(row) + 1) * width + 1],
        [](float z) { return z == DepthCells::kNone; }, kAbsent);
  for (int row = 0; row < cells.rows; ++row) {
    const float* const above = &padded[static_cast<std::size_t>(row) * width];
    const float* const rows[3] = {above, above + width, above + 2 * width};
    nearestOfNine(rows, cells.columns, &cells.around_m[cells.index(0, row)]);
  }
}

}  // namespace

std::optional<std::size_t> DepthCells::cellOf(const Eigen::Vector3d& p_camera) const {
  if (p_camera.z() < static_cast<double>(kNearest_m)) return std::nullopt;
  const double u = camera.cx_px + camera.fx_px * p_camera.x() / p_camera.z();
  const double v = camera.cy_px + camera.fy_px * p_camera.y() / p_camera.z();
  if (!(u > -0.5 && v > -0.5)) return std::nullopt;
  const double column = (u + 0.5) / cell_px, row = (v + 0.5) / cell_px;
  if (!(column < columns && row < rows)) return std::nullopt;
  return index(static_cast<int>(column), static_cast<int>(row));
}

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
  cells.near_m.assign(count, DepthCells::kNone);
  cells.around_m.resize(count);
  findNearest(depth_m, cells);
  findNearestAround(cells);
  return cells;
}

}  // namespace colonnade
