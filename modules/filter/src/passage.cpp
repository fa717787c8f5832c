// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "passage.hpp"

#include "panel_product.hpp"

namespace colonnade {

Passage::Passage(const Transfer& transfer) {
  for (Index j = 0; j < transfer.Psi.rows(); ++j) {
    if (j < 3 || transfer.Psi(j, j) != 0.0) {
      support_.push_back(j);
      continue;
    }
    for (Index i = 0; i < transfer.Phi.rows(); ++i)
      if (transfer.Phi(i, j) != 0.0) moves_.push_back({i, j, transfer.Phi(i, j)});
  }
  Phi_ = Strips(transfer.Phi(Eigen::all, support_).eval());
  Psi_ = transfer.Psi(support_, support_);
  theta_ = Strips(transfer.theta(support_, Eigen::all).transpose().eval());
}

Eigen::Matrix<double, RowPanels::kRows, 3> Passage::step(const Eigen::MatrixXd& C_support) const {
  Eigen::Matrix<double, RowPanels::kRows, 3> step =
      Eigen::Matrix<double, RowPanels::kRows, 3>::Zero();
  addPanelProduct(step.data(), C_support.data(), theta_);
  return step;
}

void Passage::carry(const RowPanels& C, Index panel, const Eigen::MatrixXd& C_support,
                    double* X) const {
  addPanelProduct(X, C_support.data(), Phi_);
  RowPanels::Panel to(X, RowPanels::kRows, Phi_.rows());
  for (const Move& move : moves_) to.col(move.to) += move.factor * C.panel(panel).col(move.from);
}

}  // namespace colonnade
