// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/detectors/floor_edge_detector.hpp"
#include "colonnade/detectors/levelled_camera.hpp"

namespace colonnade {

/// A line on the floor as the camera sees it: angle of the normal from the camera's foot to the
/// line, in the robot's axes, and its length.
struct FloorLine {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();  ///< radians, metres
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  double begin = 0.0;  ///< part used, along the image line
  double end = 0.0;
  Eigen::Vector2d p_robot_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_robot_b = Eigen::Vector2d::Zero();
};

/// Maps the part of an image line that can lie on the floor within reach; nothing if there is none
/// or the line passes through the camera's foot. R holds the errors of the fit, of the line as a
/// whole, of tilt and height, carried through the plane by numeric derivatives.
std::optional<FloorLine> mapToFloor(const LevelledCamera& camera, const RefinedLine& line,
                                    const FloorEdgeOptions& options,
                                    const GeometryOptions& geometry);

}  // namespace colonnade
