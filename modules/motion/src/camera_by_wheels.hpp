// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion_options.hpp"
#include "se3.hpp"

namespace colonnade {

/// Where the wheels carried the camera between two frames.
struct CameraByWheels {
  Eigen::Isometry3d T_previous_camera = Eigen::Isometry3d::Identity();
  /// Of e (metres, then radians, axes of the camera now) in T_true = T * exp(e).
  Matrix6 covariance = Matrix6::Zero();
};

/// Needs the odometry of both frames. What the wheels do not tell, that the robot nods and sways,
/// has a sigma of its own.
CameraByWheels cameraByWheels(const OdometryReading& previous, const OdometryReading& now,
                              const Eigen::Isometry3d& T_robot_camera_previous,
                              const Eigen::Isometry3d& T_robot_camera_now,
                              const MotionOptions& options);

}  // namespace colonnade
