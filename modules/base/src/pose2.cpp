// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/pose2.hpp"

#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {

Eigen::Matrix2d Pose2::rotation() const { return Eigen::Rotation2Dd(phi).toRotationMatrix(); }

Pose2 Pose2::inverse() const {
  const Eigen::Vector2d t = -(rotation().transpose() * translation());
  return {t.x(), t.y(), -phi};
}

Eigen::Isometry3d Pose2::toIsometry3() const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x, y, 0.0;
  return T;
}

Pose2 planarPart(const Eigen::Isometry3d& T_a_b) {
  const auto& R = T_a_b.linear();
  return {T_a_b.translation().x(), T_a_b.translation().y(), std::atan2(R(1, 0), R(0, 0))};
}

Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c, Eigen::Matrix3d* J_a_b,
              Eigen::Matrix3d* J_b_c) {
  const Eigen::Matrix2d R = T_a_b.rotation();
  const Eigen::Vector2d rotated = R * T_b_c.translation();
  if (J_a_b) {
    J_a_b->setIdentity();
    (*J_a_b)(0, 2) = -rotated.y();
    (*J_a_b)(1, 2) = rotated.x();
  }
  if (J_b_c) {
    J_b_c->setIdentity();
    J_b_c->topLeftCorner<2, 2>() = R;
  }
  return {T_a_b.x + rotated.x(), T_a_b.y + rotated.y(), wrapAngle(T_a_b.phi + T_b_c.phi)};
}

Eigen::Matrix2d spreadOverTurn(double turn) {
  // Taylor approximation below 1e-4 rad: the next terms are turn^4 / 120 and turn^3 / 24.
  const bool small = std::abs(turn) < 1e-4;
  const double s = small ? 1.0 - turn * turn / 6.0 : std::sin(turn) / turn;
  const double c = small ? 0.5 * turn : (1.0 - std::cos(turn)) / turn;
  return (Eigen::Matrix2d() << s, -c, c, s).finished();
}

Pose2 exponential(const Eigen::Vector3d& xi) {
  const Eigen::Vector2d t = spreadOverTurn(xi(2)) * xi.head<2>();
  return {t.x(), t.y(), wrapAngle(xi(2))};
}

Eigen::Vector2d transform(const Pose2& T_a_b, const Eigen::Vector2d& p_b,
                          Eigen::Matrix<double, 2, 3>* J_pose, Eigen::Matrix2d* J_point) {
  const Eigen::Matrix2d R = T_a_b.rotation();
  const Eigen::Vector2d rotated = R * p_b;
  if (J_pose) *J_pose << 1.0, 0.0, -rotated.y(), 0.0, 1.0, rotated.x();
  if (J_point) *J_point = R;
  return T_a_b.translation() + rotated;
}

}  // namespace colonnade
