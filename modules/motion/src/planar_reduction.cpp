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

/// Position is taken where the camera is: its height would be a lever that turns every small
/// disagreement of the two tilts into a step of the robot.
Pose2 planarMotion(const Eigen::Isometry3d& before, const Eigen::Isometry3d& motion,
                   const Eigen::Isometry3d& now) {
  Pose2 T = planarPart(before * motion * now.inverse());
  const Eigen::Vector2d p_before_camera = (before * motion.translation()).head<2>();
  const Eigen::Vector2d p_now_camera = now.translation().head<2>();
  const Eigen::Vector2d t = p_before_camera - T.rotation() * p_now_camera;
  T.x = t.x();
  T.y = t.y();
  return T;
}

Eigen::Vector3d planarVector(const Eigen::Isometry3d& before, const Eigen::Isometry3d& motion,
                             const Eigen::Isometry3d& now) {
  return planarMotion(before, motion, now).vector();
}

}  // namespace

MotionIncrement reduceToPlane(const CameraMotion& motion, const Eigen::Isometry3d& before,
                              const MountingAtFrame& now) {
  const Eigen::Isometry3d& T = motion.T_previous_camera;
  MotionIncrement increment;
  increment.source = motion.source;
  increment.T_previous_robot = planarPart(before * T * now.T_robot_camera.inverse());

  // Central differences of the very function above, 12 columns of exact 3D geometry.
  constexpr double kStep = 1e-5;
  const auto wrapped = [](Eigen::Vector3d difference) {
    difference.z() = wrapAngle(difference.z());
    return Eigen::Vector3d(difference / (2.0 * kStep));
  };
  Eigen::Matrix<double, 3, 6> J_motion;
  for (int i = 0; i < 6; ++i) {
    const Vector6 e = kStep * Vector6::Unit(i);
    J_motion.col(i) = wrapped(planarVector(before, T * expSe3(e), now.T_robot_camera) -
                              planarVector(before, T * expSe3(-e), now.T_robot_camera));
  }
  Eigen::Matrix3d J_now;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d e = kStep * Eigen::Vector3d::Unit(i);
    J_now.col(i) = wrapped(planarVector(before, T, disturbed(now.T_robot_camera, e)) -
                           planarVector(before, T, disturbed(now.T_robot_camera, -e)));
  }
  increment.covariance = J_motion * motion.covariance * J_motion.transpose() +
                         J_now * now.covariance * J_now.transpose();
  increment.covariance = 0.5 * (increment.covariance + increment.covariance.transpose()).eval();
  return increment;
}

}  // namespace colonnade
