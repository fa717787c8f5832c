// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/camera_tracker.hpp"
#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"
#include "colonnade/motion/mounting_estimator.hpp"

namespace colonnade {

/// The robot's planar motion from frame to frame: wheel odometry and visual odometry reduced to the
/// floor, fused by their covariances where this frame and the former one have both; else what there
/// is of them; else the former velocity with wide noise.
class MotionEstimator {
 public:
  MotionEstimator(const MotionOptions& options, std::shared_ptr<CameraTracker> tracker);
  ~MotionEstimator();

  /// Frames in the order of time, T_robot_camera as refined. The first frame gives no motion
  /// (kNone, zero covariance).
  MotionIncrement increment(const Frame& frame, const MountingUncertainty& mounting = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
