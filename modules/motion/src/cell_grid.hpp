// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// A picture in square cells, asked for points in its optical frame.
class CellGrid {
 public:
  explicit CellGrid(const PinholeCamera& camera)
      : camera_(camera),
        columns_(camera.width_px / kCell_px + 1),
        rows_(camera.height_px / kCell_px + 1) {}
  std::size_t size() const { return static_cast<std::size_t>(columns_ * rows_); }
  /// What lies outside the picture belongs to the nearest cell.
  std::size_t cellOf(const Eigen::Vector3f& p_camera) const {
    const Eigen::Vector2d p = p_camera.cast<double>().hnormalized();
    const int u = static_cast<int>(camera_.fx_px * p.x() + camera_.cx_px) / kCell_px;
    const int v = static_cast<int>(camera_.fy_px * p.y() + camera_.cy_px) / kCell_px;
    return static_cast<std::size_t>(std::clamp(v, 0, rows_ - 1) * columns_ +
                                    std::clamp(u, 0, columns_ - 1));
  }

 private:
  static constexpr int kCell_px = 16;
  PinholeCamera camera_;
  int columns_;
  int rows_;
};

}  // namespace colonnade
