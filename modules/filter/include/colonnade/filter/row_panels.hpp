// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "colonnade/base/memory.hpp"

namespace colonnade {

/// A tall matrix in panels of a few rows, each by columns without gaps: what is done panel by panel
/// stays in the fastest memory. New rows are added with a copy of the last
/// few panels at most, new columns while there is room.
class RowPanels {
 public:
  static constexpr Eigen::Index kRows = 32;
  RowPanels() = default;
  /// With room for so many columns.
  explicit RowPanels(Eigen::Index capacity) : capacity_(capacity) {}
  using Panel = Eigen::Map<Eigen::Matrix<double, kRows, Eigen::Dynamic>>;
  using ConstPanel = Eigen::Map<const Eigen::Matrix<double, kRows, Eigen::Dynamic>>;

  static Eigen::Index panelOf(Eigen::Index row) { return row / kRows; }
  Eigen::Index panels() const { return panels_; }
  Eigen::Index cols() const { return cols_; }
  /// Room for so many rows; new ones, up to the end of their panel, are zero.
  void growRows(Eigen::Index rows);
  /// Room for so many columns.
  void reserveCols(Eigen::Index cols);
  /// The first columns stay; new ones are zero.
  void setCols(Eigen::Index cols);
  /// So many columns go; the others move to the front.
  void dropFirstCols(Eigen::Index cols);

  Panel panel(Eigen::Index panel) { return {column(panel, 0), kRows, cols_}; }
  ConstPanel panel(Eigen::Index panel) const { return {column(panel, 0), kRows, cols_}; }
  const double* column(Eigen::Index panel, Eigen::Index column) const {
    return groups_[static_cast<std::size_t>(panel / kTogether)].data() +
           (panel % kTogether * capacity_ + column) * kRows;
  }
  double* column(Eigen::Index panel, Eigen::Index column) {
    return const_cast<double*>(std::as_const(*this).column(panel, column));
  }
  auto row(Eigen::Index row) { return panel(panelOf(row)).row(row % kRows); }
  auto row(Eigen::Index row) const { return panel(panelOf(row)).row(row % kRows); }
  Eigen::MatrixXd rows(std::span<const Eigen::Index> rows) const;
  Eigen::MatrixXd rows(std::span<const Eigen::Index> rows,
                       std::span<const Eigen::Index> columns) const;

 private:
  /// So many panels lie in memory together.
  static constexpr Eigen::Index kTogether = 32;
  Eigen::Index panels_ = 0;
  Eigen::Index cols_ = 0;
  Eigen::Index capacity_ = 0;  ///< columns a panel has room for
  std::vector<std::vector<double, LargeAllocator<double>>> groups_;
};

}  // namespace colonnade
