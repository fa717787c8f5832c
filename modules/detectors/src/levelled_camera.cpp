// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/levelled_camera.hpp"

#include <Eigen/Geometry>

#include "colonnade/base/error.hpp"

namespace colonnade {

LevelledCamera::LevelledCamera(const Frame& frame)
    : camera_(frame.camera),
      R_robot_camera_(frame.T_robot_camera.linear()),
      p_robot_camera_(frame.T_robot_camera.translation()) {
  if (!camera_.isCalibrated()) {
    throw Error("detectors: the frame's camera has no focal length; give a calibration");
  }
  setRays();
}

void LevelledCamera::setRays() {
  ray_per_u_ = R_robot_camera_.col(0) / camera_.fx_px;
  ray_per_v_ = R_robot_camera_.col(1) / camera_.fy_px;
  ray_at_0_ = R_robot_camera_ * camera_.ray(0.0, 0.0);
}

LevelledCamera LevelledCamera::disturbed(const Eigen::Vector2d& tilt, double height_m) const {
  LevelledCamera other = *this;
  other.R_robot_camera_ = Eigen::AngleAxisd(tilt.x(), Eigen::Vector3d::UnitX()).toRotationMatrix() *
                          Eigen::AngleAxisd(tilt.y(), Eigen::Vector3d::UnitY()).toRotationMatrix() *
                          R_robot_camera_;
  other.p_robot_camera_.z() += height_m;
  other.setRays();
  return other;
}

std::optional<Eigen::Vector2d> LevelledCamera::floorPoint(const Eigen::Vector2d& p_px) const {
  const Eigen::Vector3d r = ray(p_px);
  constexpr double kGrazing = 1e-3;  // beyond 1000 camera heights there is no floor to see
  if (height() <= 0.0 || r.z() > -kGrazing * r.head<2>().norm()) return std::nullopt;
  return p_robot_camera_.head<2>() - height() / r.z() * r.head<2>();
}

std::optional<Eigen::Vector2d> LevelledCamera::project(const Eigen::Vector3d& p_robot) const {
  const Eigen::Vector3d p_camera = R_robot_camera_.transpose() * (p_robot - p_robot_camera_);
  constexpr double kNearest_m = 0.05;
  if (p_camera.z() < kNearest_m) return std::nullopt;
  return Eigen::Vector2d(camera_.cx_px + camera_.fx_px * p_camera.x() / p_camera.z(),
                         camera_.cy_px + camera_.fy_px * p_camera.y() / p_camera.z());
}

Eigen::Vector2d LevelledCamera::downDirection(const Eigen::Vector2d& p_px) const {
  // Towards the vanishing point of the vertical, K * R_camera_robot * (0, 0, -1), kept homogeneous
  // because it lies at infinity for a level camera.
  const Eigen::Vector3d down = -R_robot_camera_.row(2).transpose();
  const Eigen::Vector2d direction(camera_.fx_px * down.x() + (camera_.cx_px - p_px.x()) * down.z(),
                                  camera_.fy_px * down.y() + (camera_.cy_px - p_px.y()) * down.z());
  const double length = direction.norm();
  return length > 0.0 ? Eigen::Vector2d(direction / length) : Eigen::Vector2d(0.0, 1.0);
}

}  // namespace colonnade
