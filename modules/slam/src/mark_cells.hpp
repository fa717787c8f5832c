// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "colonnade/slam/place_finder.hpp"

namespace colonnade {

/// Marks by square cells, for those near a point.
class MarkCells {
 public:
  MarkCells(std::span<const PlaceMark> marks, double side_m) : marks_(marks), side_m_(side_m) {
    for (std::size_t i = 0; i < marks.size(); ++i) cells_[keyOf(cellOf(marks[i].p))].push_back(i);
  }
  /// Calls visit(index, distance) for marks within `reach_m`, at most a side of a cell.
  template <class Visit>
  void near(const Eigen::Vector2d& p, double reach_m, Visit visit) const {
    const Eigen::Vector2i middle = cellOf(p);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(keyOf(middle + Eigen::Vector2i(dx, dy)));
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second)
          if (const double d = (marks_[i].p - p).norm(); d <= reach_m) visit(i, d);
      }
    }
  }

 private:
  Eigen::Vector2i cellOf(const Eigen::Vector2d& p) const {
    return (p / side_m_).array().floor().cast<int>();
  }
  static std::int64_t keyOf(const Eigen::Vector2i& cell) {
    return (static_cast<std::int64_t>(cell.x()) << 32) ^ static_cast<std::uint32_t>(cell.y());
  }
  std::span<const PlaceMark> marks_;
  double side_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace colonnade
