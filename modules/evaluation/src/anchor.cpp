// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/anchor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace colonnade {
namespace {

constexpr double kNegligibleShare = 0.01;  ///< of a variance: a tenth of a standard deviation

}  // namespace

Eigen::Matrix3d Anchor::doubtAt(const Eigen::Vector2d& p_estimate) const {
  const Eigen::Vector2d arm = p_estimate - T_estimate_body.translation();
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -arm.y();
  J(1, 2) = arm.x();
  return J * covariance * J.transpose();
}

bool Anchor::serves(const Eigen::Vector2d& p_estimate, const Eigen::MatrixXd& P) const {
  if (covariance.isZero(0.0)) return true;
  const Eigen::LLT<Eigen::MatrixXd> factor(P);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::MatrixXd doubt = doubtAt(p_estimate).topLeftCorner(P.rows(), P.cols());
  const Eigen::MatrixXd half = factor.matrixL().solve(doubt);
  const Eigen::MatrixXd relative = factor.matrixL().solve(half.transpose());
  return relative.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff() <= kNegligibleShare;
}

}  // namespace colonnade
