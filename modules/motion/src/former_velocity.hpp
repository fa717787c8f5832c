// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion_options.hpp"
#include "rgbd_alignment.hpp"
#include "se3.hpp"

namespace colonnade {

/// What the former motion of the camera says of the next one.
class FormerVelocity {
 public:
  FormerVelocity() = default;
  /// The motion in dt_s, and its covariance (metres, then radians, axes of the camera after it).
  FormerVelocity(const Eigen::Isometry3d& T_previous_camera, const Matrix6& covariance, double dt_s)
      : T_previous_camera_(T_previous_camera), covariance_(covariance), dt_s_(dt_s) {}

  /// The motion of the next dt_s at the same velocity, less sure in each direction by a random
  /// change of it. What nothing measures errs the same way frame after frame, so there the sigmas
  /// add, not the variances.
  MotionPrior prior(double dt_s, const MotionOptions& options) const;

 private:
  Eigen::Isometry3d T_previous_camera_ = Eigen::Isometry3d::Identity();
  Matrix6 covariance_ = Matrix6::Zero();
  double dt_s_ = 0.0;  ///< 0: there was none
};

}  // namespace colonnade
