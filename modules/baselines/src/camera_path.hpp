// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "colonnade/base/pose2.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// Turns from the optical frame (x right, y down, z forward) to MRPT's way of hanging a range
/// camera (x forward, y left, z up), in which its visual methods work.
Eigen::Isometry3d forwardFromOptical();

/// How the camera sits on the robot in the first frame: as in the log, or from the floor in that
/// frame when the camera is carried by hand (as `colonnade run` does).
Eigen::Isometry3d firstMounting(const Frame& frame, const MotionOptions& options);

/// Lays a camera path in space onto the floor: the camera's place dropped onto it and its optical
/// axis projected, then the robot from how camera and robot sit in the plane.
class CameraPath {
 public:
  /// T_robot_camera: optical, at the first frame, whose robot is the world.
  explicit CameraPath(const Eigen::Isometry3d& T_robot_camera);
  /// T_first_camera: the optical frame now in the optical frame of the first frame.
  Pose2 robot(const Eigen::Isometry3d& T_first_camera) const;

 private:
  Eigen::Isometry3d T_world_first_;
  Pose2 T_camera_robot_;
};

}  // namespace colonnade
