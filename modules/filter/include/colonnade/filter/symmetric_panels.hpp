// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace colonnade {

/// A large symmetric matrix that grows without being copied: its lower triangle in panels of a few
/// rows, each panel from the first column to its own diagonal.
class SymmetricPanels {
 public:
  Eigen::Index size() const { return size_; }
  /// New rows and columns are zero.
  void grow(Eigen::Index size);

  double operator()(Eigen::Index row, Eigen::Index column) const;
  /// The whole column, upper part included.
  Eigen::VectorXd column(Eigen::Index column) const;
  /// Row and column `index` become `values` (size() entries).
  void setRowAndColumn(Eigen::Index index, const Eigen::VectorXd& values);

  static Eigen::Index panelOf(Eigen::Index row) { return row / kRows; }
  static Eigen::Index firstRow(Eigen::Index panel) { return panel * kRows; }
  Eigen::Index panels() const { return static_cast<Eigen::Index>(panels_.size()); }
  /// Adds D diag(weights) D^T to one panel; D has size() rows.
  void addToPanel(Eigen::Index panel, const Eigen::Ref<const Eigen::MatrixXd>& D,
                  const Eigen::Ref<const Eigen::VectorXd>& weights);

 private:
  static constexpr Eigen::Index kRows = 32;
  Eigen::Index size_ = 0;
  std::vector<Eigen::MatrixXd> panels_;  ///< kRows x (kRows (panel + 1)), column-major
};

}  // namespace colonnade
