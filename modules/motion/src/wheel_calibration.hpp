// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// What wheels always get wrong, learnt where a camera tells the motion as well: ways are too long
/// by a share of them, and the heading drifts with the way and with the turn (wheels larger than
/// stated or unlike each other, and their distance: the systematic errors of Borenstein and Feng
/// 1996, "Measurement and correction of systematic odometry errors in mobile robots"). A Kalman
/// filter over the frames; as much is expected beforehand as the noise of the options makes after
/// one metre, or one radian.
class WheelCalibration {
 public:
  explicit WheelCalibration(const MotionOptions& options);

  /// The increment without them; its covariance stays.
  MotionIncrement corrected(MotionIncrement wheels) const;
  /// Both of one motion, the wheels' as read. What is too unlike to be that is passed over.
  void learn(const MotionIncrement& wheels, const MotionIncrement& camera);

 private:
  Eigen::Vector3d prior_variances_;
  Eigen::Vector3d errors_ = Eigen::Vector3d::Zero();  ///< m per m, rad per m, rad per rad
  Eigen::Matrix3d covariance_;
};

}  // namespace colonnade
