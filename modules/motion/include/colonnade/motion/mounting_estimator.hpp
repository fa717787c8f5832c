// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "colonnade/base/angle.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/camera_tracker.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// How far the roll, pitch and height in a frame's T_robot_camera can be trusted.
struct MountingUncertainty {
  /// Of small rotations about the robot's x and y axes and of the height: rad, rad, m. What a
  /// detector should assume; most of it is depth distortion that stays from frame to frame.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// The part by which this frame's estimate may differ from the former one's.
  Eigen::Matrix3d step_covariance = Eigen::Matrix3d::Zero();
  bool floor_seen = false;  ///< in this frame; otherwise carried on by visual odometry
};

/// Finds the tilt and height of a hand-carried camera in every frame from the floor in its depth.
///
/// Robot frame of such logs: origin on the floor under the camera, z up, x the optical axis
/// projected onto the floor; so p_robot_camera = (0, 0, height). Between floors seen, the rotation
/// and climb of the visual odometry carry the estimate on, with growing uncertainty; a small Kalman
/// filter weighs both.
class MountingEstimator {
 public:
  /// `tracker` may be shared with the MotionEstimator: each frame is then tracked once.
  MountingEstimator(const MotionOptions& options, std::shared_ptr<CameraTracker> tracker);
  ~MountingEstimator();

  /// Rewrites frame.T_robot_camera, unless the mounting is fixed (by option, or with `auto` because
  /// the first frame has odometry: a robot carries the camera).
  void refine(Frame& frame);

  const MountingUncertainty& uncertainty() const;
  bool isPerFrame() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
