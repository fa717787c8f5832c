// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {
namespace {

constexpr int kSmallWidthPx = 400;

/// Square pixels, the principal point in the middle of the image.
PinholeCamera centred(int width_px, int height_px, double field_of_view) {
  const double focal = 0.5 * width_px / std::tan(0.5 * field_of_view);
  return {width_px, height_px, focal, focal, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
}

/// yaw to the left, then pitch downwards, then roll that lowers the right side.
Eigen::Isometry3d mounted(const Eigen::Vector3d& p_robot, double yaw, double pitch, double roll) {
  Eigen::Matrix3d R_forward_optical;  // columns: right, down, forward in x forward, y left, z up
  R_forward_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = p_robot;
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
               Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix() *
               R_forward_optical;
  return T;
}

}  // namespace

PinholeCamera CameraOptions::pinhole() const { return centred(width_px, height_px, field_of_view); }

Eigen::Isometry3d CameraOptions::T_robot_camera() const {
  return mounted({forward_m, left_m, height_m}, 0.0, pitch, roll);
}

int CameraOptions::renderedPerPixel() const {
  if (supersampling > 0) return supersampling;
  return width_px <= kSmallWidthPx ? 3 : 2;
}

PinholeCamera MonoOptions::pinhole() const { return centred(width_px, height_px, field_of_view); }

Eigen::Isometry3d MonoOptions::T_robot_camera() const {
  return mounted({forward_m, left_m, height_m}, yaw, pitch, roll);
}

}  // namespace colonnade
