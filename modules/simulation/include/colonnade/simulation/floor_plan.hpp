// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// The floor from above as robots' navigation programs read it: 254 free (the robot can get there),
/// 0 wall, 205 unknown. Row 0 is the largest y.
struct FloorPlan {
  cv::Mat cells;  ///< CV_8UC1
  double resolution_m = 0.05;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< world position of the lower left corner
};

FloorPlan drawFloorPlan(const Building& building, const Eigen::Vector2d& p_start,
                        double resolution_m = 0.05);

/// Writes STEM.png and STEM.yaml (the format of ROS map_server).
void writeFloorPlan(const std::filesystem::path& stem, const FloorPlan& plan);

}  // namespace colonnade
