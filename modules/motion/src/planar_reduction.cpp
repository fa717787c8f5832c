// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planar_reduction.hpp"

#include <cmath>

#include "colonnade/base/angle.hpp"
#include "se3.hpp"

namespace colonnade {
namespace {

/// The mounting with a small error; a per-frame robot frame turns with its tilt, so that x stays
/// the projected optical axis (heading of a tilted camera depends on its roll).
Eigen::Isometry3d disturbed(const Eigen::Isometry3d& T_robot_camera, const Eigen::Vector3d& error) {
  const Eigen::Vector3d turn(error.x(), error.y(), 0.0);
  Eigen::Isometry3d T = T_robot_camera;
  const double angle = turn.norm();
  if (angle > 0.0) {
    T.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * T.linear();
  }
  const Eigen::Vector3d axis_before = T_robot_camera.linear().col(2);
  const Eigen::Vector3d axis = T.linear().col(2);
  const double yaw = std::atan2(axis_before.y(), axis_before.x()) - std::atan2(axis.y(), axis.x());
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * T.linear();
  T.translation().z() += error.z();
  return T;
}

Eigen::Vector3d planarVector(const Eigen::Isometry3d& before, const Eigen::Isometry3d& motion,
                             const Eigen::Isometry3d& now) {
  return planarPart(before * motion * now.inverse()).vector();
}

}  // namespace

MotionIncrement reduceToPlane(const CameraMotion& motion, const MountingAtFrame& before,
                              const MountingAtFrame& now) {
  const Eigen::Isometry3d& T = motion.T_previous_camera;
  MotionIncrement increment;
  increment.source = motion.source;
  increment.T_previous_robot = planarPart(before.T_robot_camera * T * now.T_robot_camera.inverse());

  // Central differences of the very function above, 12 columns of exact 3D geometry.
  constexpr double kStep = 1e-5;
  const auto wrapped = [](Eigen::Vector3d difference) {
    difference.z() = wrapAngle(difference.z());
    return Eigen::Vector3d(difference / (2.0 * kStep));
  };
  Eigen::Matrix<double, 3, 6> J_motion;
  for (int i = 0; i < 6; ++i) {
    const Vector6 e = kStep * Vector6::Unit(i);
    J_motion.col(i) =
        wrapped(planarVector(before.T_robot_camera, T * expSe3(e), now.T_robot_camera) -
                planarVector(before.T_robot_camera, T * expSe3(-e), now.T_robot_camera));
  }
  Eigen::Matrix3d J_before;
  Eigen::Matrix3d J_now;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d e = kStep * Eigen::Vector3d::Unit(i);
    J_before.col(i) =
        wrapped(planarVector(disturbed(before.T_robot_camera, e), T, now.T_robot_camera) -
                planarVector(disturbed(before.T_robot_camera, -e), T, now.T_robot_camera));
    J_now.col(i) =
        wrapped(planarVector(before.T_robot_camera, T, disturbed(now.T_robot_camera, e)) -
                planarVector(before.T_robot_camera, T, disturbed(now.T_robot_camera, -e)));
  }
  increment.covariance = J_motion * motion.covariance * J_motion.transpose() +
                         J_before * before.covariance * J_before.transpose() +
                         J_now * now.covariance * J_now.transpose();
  increment.covariance = 0.5 * (increment.covariance + increment.covariance.transpose()).eval();
  return increment;
}

}  // namespace colonnade
