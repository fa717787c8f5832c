// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

PinholeCamera CameraOptions::pinhole() const {
  const double focal = 0.5 * width_px / std::tan(0.5 * field_of_view);
  return {width_px, height_px, focal, focal, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
}

Eigen::Isometry3d CameraOptions::T_robot_camera() const {
  Eigen::Matrix3d R_forward_optical;  // columns: right, down, forward in x forward, y left, z up
  R_forward_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(forward_m, left_m, height_m);
  T.linear() = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix() *
               R_forward_optical;
  return T;
}

}  // namespace colonnade
