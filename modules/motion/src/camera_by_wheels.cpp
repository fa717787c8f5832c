// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "camera_by_wheels.hpp"

#include "wheel_odometry.hpp"

namespace colonnade {
namespace {

// From frame to frame, of a robot on a floor with joints; both are guesses on the wide side.
constexpr double kSway_m = 0.005;
constexpr double kNod = radians(0.3);

}  // namespace

CameraByWheels cameraByWheels(const OdometryReading& previous, const OdometryReading& now,
                              const Eigen::Isometry3d& T_robot_camera_previous,
                              const Eigen::Isometry3d& T_robot_camera_now,
                              const MotionOptions& options) {
  const MotionIncrement moved = odometryIncrement(previous, now, options);
  CameraByWheels by_wheels;
  by_wheels.T_previous_camera =
      T_robot_camera_previous.inverse() * moved.T_previous_robot.toIsometry3() * T_robot_camera_now;
  // The increment's error has the axes of the robot before, e those of the robot now.
  Eigen::Matrix<double, 6, 3> J = Eigen::Matrix<double, 6, 3>::Zero();
  J.topLeftCorner<2, 2>() = moved.T_previous_robot.rotation().transpose();
  J(5, 2) = 1.0;
  Matrix6 robot = J * moved.covariance * J.transpose();
  robot.diagonal().head<3>().array() += kSway_m * kSway_m;
  robot.diagonal().segment<2>(3).array() += kNod * kNod;
  const Matrix6 Ad = adjoint(T_robot_camera_now.inverse());
  by_wheels.covariance = Ad * robot * Ad.transpose();
  return by_wheels;
}

}  // namespace colonnade
