// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ellipse.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {

std::vector<Eigen::Vector2d> ellipse95(const Eigen::Vector2d& mean,
                                       const Eigen::Matrix2d& covariance) {
  constexpr double kRadius = 2.4477;  // sqrt of the 95 % point of chi-squared with 2
  constexpr int kSides = 48;
  if (!covariance.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  if (solver.eigenvalues()(0) < 0.0) return {};
  const Eigen::Matrix2d axes =
      kRadius * solver.eigenvectors() * solver.eigenvalues().cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= kSides; ++i) {
    const double t = 2.0 * kPi * i / kSides;
    outline.emplace_back(mean + axes * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return outline;
}

}  // namespace colonnade
