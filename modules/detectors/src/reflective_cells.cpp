// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "reflective_cells.hpp"

#include "cell_regions.hpp"

namespace colonnade {
namespace {

/// Cells whose whole neighbourhood is marked: drops the narrow shadows beside near things.
std::vector<std::uint8_t> shrunk(const std::vector<std::uint8_t>& marks, const DepthCells& cells) {
  std::vector<std::uint8_t> result(marks.size(), 0);
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      bool all = marks[cells.index(column, row)] != 0;  // most are not
      for (int r = row - 1; all && r <= row + 1; ++r)
        for (int c = column - 1; all && c <= column + 1; ++c)
          all = !cells.contains(c, r) || marks[cells.index(c, r)] != 0;
      result[cells.index(column, row)] = all ? 1 : 0;
    }
  }
  return result;
}

struct Outline {
  int cells = 0;
  int surface = 0;  ///< with depth well within reach
};

/// The cells with depth next to a region, two cells out since the region was shrunk by one.
Outline outlineOf(const std::vector<std::size_t>& region, const std::vector<std::uint8_t>& holes,
                  const DepthCells& cells, float reach_m, std::vector<std::uint32_t>& visited,
                  std::uint32_t mark) {
  Outline outline;
  constexpr int kOut = 2;
  for (const std::size_t cell : region) {
    const int column = static_cast<int>(cell) % cells.columns;
    const int row = static_cast<int>(cell) / cells.columns;
    for (int r = row - kOut; r <= row + kOut; ++r) {
      for (int c = column - kOut; c <= column + kOut; ++c) {
        if (!cells.contains(c, r)) continue;
        const std::size_t beside = cells.index(c, r);
        if (holes[beside] || visited[beside] == mark) continue;
        visited[beside] = mark;
        ++outline.cells;
        if (cells.near_m[beside] < reach_m) ++outline.surface;
      }
    }
  }
  return outline;
}

/// A cell of a shrunk region and the holes beside it.
void markGrown(std::size_t cell, const std::vector<std::uint8_t>& holes, const DepthCells& cells,
               std::vector<std::uint8_t>& marks) {
  const int column = static_cast<int>(cell) % cells.columns;
  const int row = static_cast<int>(cell) / cells.columns;
  for (int r = row - 1; r <= row + 1; ++r)
    for (int c = column - 1; c <= column + 1; ++c)
      if (cells.contains(c, r) && holes[cells.index(c, r)]) marks[cells.index(c, r)] = 1;
}

}  // namespace

std::vector<std::uint8_t> reflectiveCells(const DepthCells& cells,
                                          const SegmentationOptions& options) {
  std::vector<std::uint8_t> holes(cells.near_m.size(), 0);
  for (std::size_t i = 0; i < holes.size(); ++i)
    holes[i] = cells.near_m[i] == DepthCells::kNone ? 1 : 0;
  const auto reach_m = static_cast<float>(options.border_reach * options.sensor_reach_m);
  std::vector<std::uint8_t> marks(holes.size(), 0);
  std::vector<std::uint32_t> visited(holes.size(), 0);
  std::uint32_t mark = 0;
  for (const auto& region : regionsOf(shrunk(holes, cells), cells.columns, cells.rows)) {
    const auto size = static_cast<double>(region.size());
    if (size < options.min_pane_share * static_cast<double>(holes.size())) continue;
    const Outline outline = outlineOf(region, holes, cells, reach_m, visited, ++mark);
    // A hole that fills the view has next to no outline: nothing can be told then.
    constexpr int kLeastOutline = 40;
    if (outline.cells < kLeastOutline) continue;
    if (outline.surface < options.min_border_share * outline.cells) continue;
    for (const std::size_t cell : region) markGrown(cell, holes, cells, marks);
  }
  return marks;
}

}  // namespace colonnade
