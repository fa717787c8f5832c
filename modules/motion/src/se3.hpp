// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace colonnade {

using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< a twist: metres (3), then radians (3)
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return S;
}

/// The exponential map of SE(3) (Sola et al., "A micro Lie theory", eq. 172 and 174).
inline Eigen::Isometry3d expSe3(const Vector6& twist) {
  const Eigen::Vector3d rho = twist.head<3>();
  const Eigen::Vector3d theta = twist.tail<3>();
  const double angle2 = theta.squaredNorm();
  const double angle = std::sqrt(angle2);
  const bool small = angle2 < 1e-10;
  const double b = small ? 0.5 - angle2 / 24.0 : (1.0 - std::cos(angle)) / angle2;
  const double c =
      small ? 1.0 / 6.0 - angle2 / 120.0 : (angle - std::sin(angle)) / (angle2 * angle);
  const double a = small ? 1.0 - angle2 / 6.0 : std::sin(angle) / angle;
  const Eigen::Matrix3d S = skew(theta);
  const Eigen::Matrix3d S2 = S * S;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Matrix3d::Identity() + a * S + b * S2;
  T.translation() = (Eigen::Matrix3d::Identity() + b * S + c * S2) * rho;
  return T;
}

/// The inverse of expSe3 for turns below pi (the same, eq. 173 and 146).
inline Vector6 logSe3(const Eigen::Isometry3d& T) {
  const Eigen::AngleAxisd turn(T.linear());
  const double angle = turn.angle();
  const Eigen::Vector3d theta = angle * turn.axis();
  const Eigen::Matrix3d S = skew(theta);
  const double c = angle < 1e-4 ? 1.0 / 12.0
                                : (1.0 - 0.5 * angle * std::sin(angle) / (1.0 - std::cos(angle))) /
                                      (angle * angle);
  Vector6 twist;
  twist.head<3>() = (Eigen::Matrix3d::Identity() - 0.5 * S + c * S * S) * T.translation();
  twist.tail<3>() = theta;
  return twist;
}

/// Ad(T): T exp(twist) = exp(Ad(T) twist) T (the same, eq. 175).
inline Matrix6 adjoint(const Eigen::Isometry3d& T) {
  Matrix6 A = Matrix6::Zero();
  A.topLeftCorner<3, 3>() = T.linear();
  A.topRightCorner<3, 3>() = skew(T.translation()) * T.linear();
  A.bottomRightCorner<3, 3>() = T.linear();
  return A;
}

/// Removes the rounding that a long product of rotations collects.
inline void orthonormalise(Eigen::Isometry3d& T) {
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
}

}  // namespace colonnade
