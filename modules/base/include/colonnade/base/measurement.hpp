// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// Up to two numbers and their covariance, without a heap allocation.
using MeasurementVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
using MeasurementCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;

/// One landmark seen once, levelled into the plane of the robot. Angles are relative to the robot's
/// heading; distances are horizontal and start at the camera, whose place on the robot is
/// p_robot_camera.
///   pillar edge    z = (bearing) or (bearing, range)
///   depth slope    z = (bearing, range)
///   floor edge     z = (direction of the normal that points from the camera to the line, distance)
/// Bearings and directions are counter-clockwise from the robot's x axis, in [-pi, pi].
struct Measurement {
  LandmarkKind kind = LandmarkKind::kPillarEdge;
  MeasurementVector z;
  MeasurementCovariance R;  ///< radians squared and metres squared
  Eigen::Vector2d p_robot_camera = Eigen::Vector2d::Zero();
  double camera_direction = 0.0;  ///< of its axis, like a bearing; where its errors are estimated

  bool hasRange() const { return z.size() == 2; }
};

}  // namespace colonnade
