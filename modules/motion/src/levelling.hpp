// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace colonnade {

/// T_robot_camera of a camera `height_m` above the floor whose up direction, seen in the optical
/// frame, is `up`: origin on the floor under the camera, z up, x the optical axis projected onto
/// the floor (a camera that looks straight up or down takes its image's upper edge instead).
inline Eigen::Isometry3d levelledMounting(const Eigen::Vector3d& up, double height_m) {
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ() - up * up.z();
  if (ahead.norm() < 1e-3) ahead = -Eigen::Vector3d::UnitY() + up * up.y();
  ahead.normalize();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().row(0) = ahead.transpose();
  T.linear().row(1) = up.cross(ahead).transpose();
  T.linear().row(2) = up.transpose();
  T.translation().z() = height_m;
  return T;
}

}  // namespace colonnade
