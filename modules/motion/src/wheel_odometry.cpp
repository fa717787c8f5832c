// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_odometry.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace colonnade {
namespace {

bool isUsable(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(0) >= -1e-12 && eigen.eigenvalues()(2) > 0.0;
}

}  // namespace

MotionIncrement odometryIncrement(const OdometryReading& previous, const OdometryReading& now,
                                  const MotionOptions& options) {
  MotionIncrement increment;
  increment.source = MotionSource::kOdometry;
  increment.T_previous_robot = previous.T_odom_robot.inverse() * now.T_odom_robot;
  const double floor_m2 = options.odometry_floor_m * options.odometry_floor_m;
  const double floor_rad2 = options.odometry_floor_angle * options.odometry_floor_angle;
  const Eigen::Vector3d floor(floor_m2, floor_m2, floor_rad2);
  if (now.increment_covariance && isUsable(*now.increment_covariance)) {
    increment.covariance = *now.increment_covariance;
    increment.covariance.diagonal() = increment.covariance.diagonal().cwiseMax(floor);
    return increment;
  }
  const auto& T = increment.T_previous_robot;
  const double way_m = T.translation().norm();
  const double turn = std::abs(T.phi);
  const auto variance = [](double sigma, double amount) { return sigma * sigma * amount; };
  const double heading =
      variance(options.odometry_heading, way_m) + variance(options.odometry_turn, turn);
  // A heading that walks randomly on the way L shifts the end across by variance * L^2 / 3, in step
  // with its own end by variance * L / 2. Along and across refer to the chord.
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(std::atan2(T.y, T.x)).toRotationMatrix();
  Eigen::Matrix2d Q = Eigen::Matrix2d::Zero();
  Q(0, 0) = variance(options.odometry_along, way_m);
  Q(1, 1) = variance(options.odometry_across, way_m) + way_m * way_m * heading / 3.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = R * Q * R.transpose();
  covariance.topRightCorner<2, 1>() = R * Eigen::Vector2d(0.0, 0.5 * way_m * heading);
  covariance.bottomLeftCorner<1, 2>() = covariance.topRightCorner<2, 1>().transpose();
  covariance(2, 2) = heading;
  covariance.diagonal() += floor;
  increment.covariance = covariance;
  return increment;
}

}  // namespace colonnade
