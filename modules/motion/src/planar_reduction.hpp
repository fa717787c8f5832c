// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "colonnade/base/pose2.hpp"
#include "colonnade/motion/camera_tracker.hpp"
#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// The mounting at one frame and the covariance of its rotations about the robot's x and y axes and
/// of its height.
struct MountingAtFrame {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The planar part of T_robot_camera(before) * T_previous_camera * T_robot_camera(now)^-1 with its
/// covariance, which includes that of both mountings.
MotionIncrement reduceToPlane(const CameraMotion& motion, const MountingAtFrame& before,
                              const MountingAtFrame& now);

}  // namespace colonnade
