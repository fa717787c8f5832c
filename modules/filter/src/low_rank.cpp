// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "low_rank.hpp"

#include <Eigen/Eigenvalues>

#include "panel_product.hpp"

namespace colonnade {
namespace {

/// Parts of a change of P smaller than this share of its largest are rounding.
constexpr double kRounding = 1e-13;

/// Psi = F F^T.
Eigen::MatrixXd squareRoot(const Eigen::MatrixXd& Psi) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Psi);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// How many of the last columns of a factor make up its square but for rounding; the columns are
/// in the order of their squares.
Eigen::Index rankOf(const Eigen::VectorXd& squares) {
  const Eigen::Index size = squares.size();
  if (size == 0 || !(squares(size - 1) > 0.0)) return 0;
  return (squares.array() > kRounding * squares(size - 1)).count();
}

/// How many of the first columns of `parts` can go before the sum of their squares is more than
/// `negligible` in a row.
Eigen::Index negligibleColumns(const Eigen::MatrixXd& parts, double negligible) {
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(parts.rows());
  for (Eigen::Index column = 0; column < parts.cols(); ++column) {
    lost += parts.col(column).cwiseAbs2();
    if (lost.maxCoeff() > negligible) return column;
  }
  return parts.cols();
}

}  // namespace

Eigen::MatrixXd lowRankFactor(const Eigen::MatrixXd& C_judged, const Eigen::MatrixXd& Psi,
                              double negligible) {
  const Eigen::MatrixXd F = squareRoot(Psi);
  const Eigen::MatrixXd rows = C_judged.transpose();
  const Eigen::MatrixXd outer = F.transpose() * productOfRows(rows, rows) * F;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(outer);
  Eigen::MatrixXd A = F * spectrum.eigenvectors().rightCols(rankOf(spectrum.eigenvalues()));
  if (negligible <= 0.0) return A;
  return A
      .rightCols(A.cols() - negligibleColumns(productOfRows(C_judged, A.transpose()), negligible))
      .eval();
}

}  // namespace colonnade
