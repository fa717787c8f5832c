// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace colonnade {

/// A rigid motion of the plane, SE(2): metres and radians, phi in [-pi, pi].
/// `T_a_b` maps points of frame b into frame a.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double phi = 0.0;

  Eigen::Vector2d translation() const { return {x, y}; }
  Eigen::Matrix2d rotation() const;
  Pose2 inverse() const;
  Eigen::Vector3d vector() const { return {x, y, phi}; }
  Eigen::Isometry3d toIsometry3() const;
};

/// The planar part of a rigid motion of space: x, y and the heading of its x axis.
Pose2 planarPart(const Eigen::Isometry3d& T_a_b);

/// T_a_c = T_a_b * T_b_c, with the 3x3 Jacobians in (x, y, phi) of either factor where asked for.
Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c, Eigen::Matrix3d* J_a_b = nullptr,
              Eigen::Matrix3d* J_b_c = nullptr);
inline Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) { return compose(T_a_b, T_b_c); }

/// The left Jacobian of SE(2): what a displacement becomes when it is spread over a turn (Sola et
/// al., arXiv 1812.01537, eq. 158). Without it a point that should stay where it is, because turn
/// and displacement cancel, creeps towards the origin by half the squared turn in every step.
Eigen::Matrix2d spreadOverTurn(double turn);
/// The motion that displaces by (xi(0), xi(1)) while it turns by xi(2): Exp(xi), eq. 156 there.
Pose2 exponential(const Eigen::Vector3d& xi);

/// p_a = T_a_b * p_b, with the 2x3 Jacobian in the pose and the 2x2 one in the point.
Eigen::Vector2d transform(const Pose2& T_a_b, const Eigen::Vector2d& p_b,
                          Eigen::Matrix<double, 2, 3>* J_pose = nullptr,
                          Eigen::Matrix2d* J_point = nullptr);

}  // namespace colonnade
