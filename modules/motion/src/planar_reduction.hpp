// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "colonnade/base/pose2.hpp"
#include "colonnade/motion/camera_tracker.hpp"
#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// The mounting at one frame and the covariance of the rotations about the robot's x and y axes and
/// of the height by which it may have erred since the former frame.
struct MountingAtFrame {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The planar part of T_robot_camera_before * T_previous_camera * T_robot_camera(now)^-1, with the
/// position taken at the camera, and its covariance, which includes that of the mounting.
MotionIncrement reduceToPlane(const CameraMotion& motion,
                              const Eigen::Isometry3d& T_robot_camera_before,
                              const MountingAtFrame& now);

}  // namespace colonnade
