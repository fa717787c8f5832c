// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// A depth image in square cells, about 80 to a row.
struct DepthCells {
  static constexpr float kNone = 0.0F;

  int cell_px = 0;
  int columns = 0;
  int rows = 0;
  PinholeCamera camera;
  std::vector<float> near_m;    ///< nearest depth in the cell; kNone where less than a quarter has
  std::vector<float> around_m;  ///< nearest in the 3 x 3 cells around; kNone where few have depth

  bool empty() const { return near_m.empty(); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  /// In which a point of the camera's axes is seen; nothing behind it or beside the image.
  std::optional<std::size_t> cellOf(const Eigen::Vector3d& p_camera) const;
  /// The viewing ray of a cell's middle, z = 1.
  Eigen::Vector3d ray(int column, int row) const {
    const double half = 0.5 * (cell_px - 1);
    return camera.ray(column * cell_px + half, row * cell_px + half);
  }
};

/// Empty where the frame has no depth that belongs to its image.
DepthCells makeDepthCells(const Frame& frame);

}  // namespace colonnade
