// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "former_velocity.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

Eigen::Isometry3d scaledMotion(const Eigen::Isometry3d& T, double factor) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const Eigen::AngleAxisd turn(T.linear());
  out.linear() = Eigen::AngleAxisd(factor * turn.angle(), turn.axis()).toRotationMatrix();
  out.translation() = factor * T.translation();
  return out;
}

}  // namespace

MotionPrior FormerVelocity::prior(double dt_s, const MotionOptions& options) const {
  const double time_s = std::max(dt_s, 0.01);
  Vector6 change;
  change << Eigen::Vector3d::Constant(options.coasting_speed_sigma_m_s * time_s),
      Eigen::Vector3d::Constant(options.coasting_turn_sigma * time_s);
  const double most = std::max(1.0, 0.5 * options.max_speed_m_s / options.coasting_speed_sigma_m_s);
  MotionPrior prior;
  Vector6 inverse_variances = Vector6::Constant(1.0 / (most * most));
  Matrix6 directions = Matrix6::Identity();
  if (dt_s_ > 0.0) {
    prior.T_reference_current =
        scaledMotion(T_previous_camera_, std::clamp(dt_s / dt_s_, 0.0, 5.0));
    const Vector6 scale = (time_s / dt_s_) * change.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
        Matrix6(scale.asDiagonal() * covariance_ * scale.asDiagonal()));
    directions = eigen.eigenvectors();
    for (int i = 0; i < 6; ++i) {
      const double sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()(i))) + 1.0;
      inverse_variances(i) = 1.0 / std::pow(std::min(sigma, most), 2);
    }
  }
  const Vector6 inverse_change = change.cwiseInverse();
  prior.information =
      inverse_change.asDiagonal() *
      Matrix6(directions * inverse_variances.asDiagonal() * directions.transpose()) *
      inverse_change.asDiagonal();
  return prior;
}

}  // namespace colonnade
