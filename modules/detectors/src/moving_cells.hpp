// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "colonnade/detectors/segmentation.hpp"
#include "depth_cells.hpp"

namespace colonnade {

/// A part of a wall, in plan.
struct WallLine {
  Eigen::Vector2d p_world;  ///< one end
  Eigen::Vector2d along;    ///< to the other
  double length_m;
};

/// Depth seen at one time, and from where in a world that holds still.
struct DepthGlimpse {
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  DepthCells cells;
  std::vector<std::uint8_t> moving;  ///< cells that moved then; empty: could not be told
  std::vector<WallLine> walls;
};

class Background;

/// Marks the cells of `now` that contradict `former` in a static world. False when so much does
/// that the motion between the views must be wrong.
bool markMoving(const DepthGlimpse& now, const DepthGlimpse& former, Background& background,
                const SegmentationOptions& options, std::vector<std::uint8_t>& marks);

/// Drops marks in regions too small, then spreads the rest over the surfaces they lie on, but never
/// along the floor.
void completeMoving(const DepthGlimpse& now, const Frame& frame, Background& background,
                    const SegmentationOptions& options, std::vector<std::uint8_t>& marks);

}  // namespace colonnade
