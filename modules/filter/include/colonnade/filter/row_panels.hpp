// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace colonnade {

/// A tall matrix in panels of a few rows, each by columns without gaps: what is done panel by panel
/// stays in the fastest memory, and it grows in both directions without being copied.
class RowPanels {
 public:
  static constexpr Eigen::Index kRows = 32;
  using Panel = Eigen::Map<Eigen::Matrix<double, kRows, Eigen::Dynamic>>;
  using ConstPanel = Eigen::Map<const Eigen::Matrix<double, kRows, Eigen::Dynamic>>;

  static Eigen::Index panelOf(Eigen::Index row) { return row / kRows; }
  Eigen::Index panels() const { return static_cast<Eigen::Index>(panels_.size()); }
  Eigen::Index cols() const { return cols_; }
  /// Room for so many rows; new ones, up to the end of their panel, are zero.
  void growRows(Eigen::Index rows);
  /// The first columns stay; new ones are zero.
  void setCols(Eigen::Index cols);
  /// So many columns go; the others move to the front.
  void dropFirstCols(Eigen::Index cols);

  Panel panel(Eigen::Index panel) { return {column(panel, 0), kRows, cols_}; }
  ConstPanel panel(Eigen::Index panel) const { return {column(panel, 0), kRows, cols_}; }
  double* column(Eigen::Index panel, Eigen::Index column) {
    return panels_[static_cast<std::size_t>(panel)].data() + column * kRows;
  }
  const double* column(Eigen::Index panel, Eigen::Index column) const {
    return panels_[static_cast<std::size_t>(panel)].data() + column * kRows;
  }
  auto row(Eigen::Index row) { return panel(panelOf(row)).row(row % kRows); }
  auto row(Eigen::Index row) const { return panel(panelOf(row)).row(row % kRows); }
  Eigen::MatrixXd rows(std::span<const Eigen::Index> rows) const;
  Eigen::MatrixXd rows(std::span<const Eigen::Index> rows,
                       std::span<const Eigen::Index> columns) const;

 private:
  Eigen::Index cols_ = 0;
  std::vector<std::vector<double>> panels_;
};

}  // namespace colonnade
