// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "camera_path.hpp"

#include <cmath>
#include <memory>

#include "colonnade/motion/camera_tracker.hpp"
#include "colonnade/motion/mounting_estimator.hpp"

namespace colonnade {
namespace {

Pose2 onFloor(const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Vector3d p = T_world_camera.translation();
  const Eigen::Vector3d axis = T_world_camera.linear().col(2);
  return {p.x(), p.y(), std::atan2(axis.y(), axis.x())};
}

}  // namespace

Eigen::Isometry3d forwardFromOptical() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T;
}

Eigen::Isometry3d firstMounting(const Frame& frame, const MotionOptions& options) {
  Frame refined = frame;
  MountingEstimator(options, std::make_shared<CameraTracker>(options)).refine(refined);
  return refined.T_robot_camera;
}

CameraPath::CameraPath(const Eigen::Isometry3d& T_robot_camera)
    : T_world_first_(T_robot_camera), T_camera_robot_(onFloor(T_robot_camera).inverse()) {}

Pose2 CameraPath::robot(const Eigen::Isometry3d& T_first_camera) const {
  return onFloor(T_world_first_ * T_first_camera) * T_camera_robot_;
}

}  // namespace colonnade
