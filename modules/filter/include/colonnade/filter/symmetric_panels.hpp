// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "colonnade/base/memory.hpp"
#include "colonnade/filter/row_panels.hpp"
#include "colonnade/filter/strips.hpp"

namespace colonnade {

/// A large symmetric matrix that grows without being copied: its lower triangle in panels of a few
/// rows, each panel from the first column to the end of its own square on the diagonal.
class SymmetricPanels {
 public:
  static constexpr Eigen::Index kRows = RowPanels::kRows;
  Eigen::Index panels() const { return panels_; }
  /// Room for so many rows; new rows and columns, up to the end of their panel, are zero.
  void grow(Eigen::Index size);

  double operator()(Eigen::Index row, Eigen::Index column) const;
  /// The rows of one panel of some columns: kRows x columns.size(), by columns.
  void readRows(Eigen::Index panel, std::span<const Eigen::Index> columns, double* to) const;
  /// The same entries, and with them those across the diagonal, become the values `from`.
  void writeRows(Eigen::Index panel, std::span<const Eigen::Index> columns, const double* from);
  /// Takes A B^T from one panel, its triangle and the tile on the diagonal; B has as many rows at
  /// least.
  void subtractProduct(Eigen::Index panel, const Eigen::Ref<const Eigen::MatrixXd>& A,
                       const Strips& B);

 private:
  /// So many panels lie in memory together, each as wide as the last of them.
  static constexpr Eigen::Index kTogether = 4;
  const double* tile(Eigen::Index panel, Eigen::Index column) const {
    const Eigen::Index group = panel / kTogether;
    const Eigen::Index width = (group + 1) * kTogether * kRows;
    return groups_[static_cast<std::size_t>(group)].data() +
           (panel % kTogether * width + column) * kRows;
  }
  double* tile(Eigen::Index panel, Eigen::Index column) {
    return const_cast<double*>(std::as_const(*this).tile(panel, column));
  }
  Eigen::Index panels_ = 0;
  std::vector<std::vector<double, LargeAllocator<double>>> groups_;
};

}  // namespace colonnade
