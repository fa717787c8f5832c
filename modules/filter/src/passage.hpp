// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/filter/row_panels.hpp"
#include "colonnade/filter/state.hpp"
#include "colonnade/filter/strips.hpp"

namespace colonnade {

/// What the state went through since the last exchange, as the resting part needs it. The
/// parameters of the state at that exchange by which it changed are the robot's and those measured:
/// they are the support. Where Psi is zero, Phi says only where a parameter went: it is that of the
/// identity, but for blocks that were removed or converted.
class Passage {
 public:
  using Index = Eigen::Index;
  explicit Passage(const Transfer& transfer);

  /// Parameters of the state at the last exchange, ascending.
  const std::vector<Index>& support() const { return support_; }
  const Eigen::MatrixXd& Psi() const { return Psi_; }  ///< of the support

  /// The columns of the support of one panel of C, as the functions below take them.
  void gather(const RowPanels& C, Index panel, Eigen::MatrixXd& C_support) const {
    C_support = C.panel(panel)(Eigen::all, support_);
  }
  /// C theta: what the values of these rows went by.
  Eigen::Matrix<double, RowPanels::kRows, 3> step(const Eigen::MatrixXd& C_support) const;
  /// X = C Phi^T, the covariance of these rows with the state as it is now; to be zero before.
  void carry(const RowPanels& C, Index panel, const Eigen::MatrixXd& C_support, double* X) const;

 private:
  struct Move {
    Index to;
    Index from;
    double factor;
  };
  std::vector<Index> support_;
  Strips Phi_;  ///< columns of the support
  Eigen::MatrixXd Psi_;
  Strips theta_;  ///< of the support, transposed
  std::vector<Move> moves_;
};

}  // namespace colonnade
