// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// Which cells of a floor are free, as a navigation program reads it.
struct FloorMap {
  int width = 0;
  int height = 0;
  double resolution_m = 0.05;
  Pose2 T_world_corner;            ///< of the lower left corner
  std::vector<std::uint8_t> free;  ///< 1 where free; row 0 is the one of least y

  bool isFree(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height &&
           free[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(column)] != 0;
  }
  std::size_t freeCells() const;
};

/// Reads NAME.yaml and the picture it names (image, resolution, origin, negate, free_thresh; the
/// format of ROS map_server). Throws Error naming the file for what is missing or no number, a
/// picture that cannot be read, and a map without a free cell.
FloorMap readFloorMap(const std::filesystem::path& yaml);

}  // namespace colonnade
