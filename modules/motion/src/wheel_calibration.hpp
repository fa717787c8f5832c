// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// What wheels always get wrong, learnt where a camera tells the motion as well: ways are too long
/// by a share of them, and the heading drifts with the way, backwards the other way round, and with
/// the turn (wheels larger than stated or unlike each other, and their distance: the systematic
/// errors of Borenstein and Feng 1996, "Measurement and correction of systematic odometry errors in
/// mobile robots"). A Kalman filter over pieces of the way; as much is expected beforehand as the
/// noise of the options makes after one metre, or one radian.
class WheelCalibration {
 public:
  explicit WheelCalibration(const MotionOptions& options);

  /// The increment without them; its covariance stays.
  MotionIncrement corrected(MotionIncrement wheels) const;
  /// Both of one motion, the wheels' as read. What is too unlike to be that is passed over.
  void learn(const MotionIncrement& wheels, const MotionIncrement& camera);

 private:
  /// Sums over a piece of the way. Of a single frame the motion is hardly more than the camera's
  /// noise, and that would pass for an error of the wheels: both are the difference of the two.
  struct Piece {
    Eigen::Vector2d camera = Eigen::Vector2d::Zero();  ///< way and turn: m, rad
    Eigen::Vector2d excess = Eigen::Vector2d::Zero();  ///< of the wheels
    Eigen::Matrix2d camera_covariance = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the excess
  };
  void learn(const Piece& piece);
  void forget(double way_m);

  bool enabled_;
  Eigen::Vector3d prior_variances_;
  Eigen::Vector3d errors_ = Eigen::Vector3d::Zero();  ///< m per m, rad per m, rad per rad
  Eigen::Matrix3d covariance_;
  Piece piece_;
};

}  // namespace colonnade
