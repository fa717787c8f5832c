// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "colonnade/filter/row_panels.hpp"

namespace colonnade {

/// A large symmetric matrix that grows without being copied: its lower triangle in panels of a few
/// rows, each panel from the first column to the end of its own square on the diagonal.
class SymmetricPanels {
 public:
  static constexpr Eigen::Index kRows = RowPanels::kRows;
  Eigen::Index panels() const { return static_cast<Eigen::Index>(panels_.size()); }
  /// Room for so many rows; new rows and columns, up to the end of their panel, are zero.
  void grow(Eigen::Index size);

  double operator()(Eigen::Index row, Eigen::Index column) const;
  /// The rows of one panel of some columns: kRows x columns.size(), by columns.
  void readRows(Eigen::Index panel, std::span<const Eigen::Index> columns, double* to) const;
  /// The same entries, and with them those across the diagonal, become the values `from`.
  void writeRows(Eigen::Index panel, std::span<const Eigen::Index> columns, const double* from);
  /// Takes D D^T from one panel, D the first `cols` columns of a matrix.
  void subtractSquare(Eigen::Index panel, const RowPanels& D, Eigen::Index cols);

 private:
  double* tile(Eigen::Index panel, Eigen::Index column) {
    return panels_[static_cast<std::size_t>(panel)].data() + column * kRows;
  }
  const double* tile(Eigen::Index panel, Eigen::Index column) const {
    return panels_[static_cast<std::size_t>(panel)].data() + column * kRows;
  }
  std::vector<std::vector<double>> panels_;  ///< kRows x (kRows (panel + 1)), by columns
};

}  // namespace colonnade
