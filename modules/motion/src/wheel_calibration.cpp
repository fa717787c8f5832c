// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "fusion.hpp"

namespace colonnade {
namespace {

/// Tyres wear and floors change: over so long a way all of it is forgotten.
constexpr double kForgotten_m = 100.0;
constexpr double kMostSigmas = 3.0;

/// The excess of the wheels' (x, phi) per systematic error, about a motion.
Eigen::Matrix<double, 2, 3> excess(const Pose2& motion) {
  const double way_m = motion.translation().norm();
  Eigen::Matrix<double, 2, 3> H;
  H << motion.x, 0.0, 0.0, 0.0, way_m, motion.phi;
  return H;
}

Eigen::Matrix2d ofWayAndTurn(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix2d part;
  part << covariance(0, 0), covariance(0, 2), covariance(2, 0), covariance(2, 2);
  return part;
}

}  // namespace

WheelCalibration::WheelCalibration(const MotionOptions& options)
    : prior_variances_(
          Eigen::Vector3d(options.odometry_along, options.odometry_heading, options.odometry_turn)
              .cwiseAbs2()),
      covariance_(prior_variances_.asDiagonal()) {}

MotionIncrement WheelCalibration::corrected(MotionIncrement wheels) const {
  Pose2& motion = wheels.T_previous_robot;
  motion.x /= 1.0 + errors_(0);
  motion.y /= 1.0 + errors_(0);
  motion.phi =
      wrapAngle((motion.phi - errors_(1) * motion.translation().norm()) / (1.0 + errors_(2)));
  return wheels;
}

void WheelCalibration::learn(const MotionIncrement& wheels, const MotionIncrement& camera) {
  const Pose2& motion = camera.T_previous_robot;
  const Eigen::Matrix<double, 2, 3> H = excess(motion);
  const Eigen::Vector2d nu = Eigen::Vector2d(wheels.T_previous_robot.x - motion.x,
                                             wrapAngle(wheels.T_previous_robot.phi - motion.phi)) -
                             H * errors_;
  const Eigen::Matrix2d S = H * covariance_ * H.transpose() + ofWayAndTurn(wheels.covariance) +
                            ofWayAndTurn(camera.covariance);
  const Eigen::LLT<Eigen::Matrix2d> llt(S);
  if (llt.info() != Eigen::Success || !(nu.dot(llt.solve(nu)) < kUsual)) return;
  const Eigen::Matrix<double, 3, 2> K = llt.solve(H * covariance_).transpose();
  errors_ += K * nu;
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K * H;
  covariance_ =
      A * covariance_ * A.transpose() + K * (S - H * covariance_ * H.transpose()) * K.transpose();
  covariance_.diagonal() += motion.translation().norm() / kForgotten_m * prior_variances_;
  const Eigen::Vector3d most = kMostSigmas * prior_variances_.cwiseSqrt();
  errors_ = errors_.cwiseMax(-most).cwiseMin(most);
}

}  // namespace colonnade
