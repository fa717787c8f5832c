// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/pose2.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

enum class MotionSource {
  kNone,
  kOdometry,
  kOdometryVisual,  ///< both, weighted by their covariances
  kPhotometric,
  kPhotometricIcp,
  kIcp,
  kFloor,  ///< the floor's texture, where there is no depth
  kConstantVelocity
};
const char* name(MotionSource source);

/// How the robot moved from the former frame to this one.
struct MotionIncrement {
  Pose2 T_previous_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (x, y, phi) in the former robot's axes
  MotionSource source = MotionSource::kNone;

  /// False: the first frame, or a guess from the former velocity.
  bool isMeasured() const {
    return source != MotionSource::kNone && source != MotionSource::kConstantVelocity;
  }
};

}  // namespace colonnade
