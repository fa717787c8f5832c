// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/row_panels.hpp"

#include <algorithm>

namespace colonnade {

void RowPanels::growRows(Eigen::Index rows) {
  panels_ = std::max(panels_, (rows + kRows - 1) / kRows);
  // Small maps do not pay for memory of large ones: the last group grows by a quarter.
  constexpr Eigen::Index kQuarter = kTogether / 4;
  for (Eigen::Index first = 0; first < panels_; first += kTogether) {
    const auto group = static_cast<std::size_t>(first / kTogether);
    const Eigen::Index needed = (panels_ - first + kQuarter - 1) / kQuarter * kQuarter;
    const auto size = static_cast<std::size_t>(std::min(kTogether, needed) * capacity_ * kRows);
    if (group == groups_.size()) groups_.emplace_back();
    if (groups_[group].size() < size) groups_[group].resize(size);
  }
}

void RowPanels::reserveCols(Eigen::Index cols) {
  if (cols <= capacity_) return;
  RowPanels larger(cols);
  larger.growRows(panels_ * kRows);
  for (Eigen::Index panel = 0; panel < panels_; ++panel)
    std::copy_n(column(panel, 0), cols_ * kRows, larger.column(panel, 0));
  larger.cols_ = cols_;
  *this = std::move(larger);
}

void RowPanels::setCols(Eigen::Index cols) {
  if (cols > capacity_) reserveCols(cols + cols / 4);
  for (Eigen::Index panel = 0; panel < panels_ && cols > cols_; ++panel)
    std::fill_n(column(panel, cols_), (cols - cols_) * kRows, 0.0);
  cols_ = cols;
}

void RowPanels::dropFirstCols(Eigen::Index cols) {
  cols_ -= cols;
  for (Eigen::Index panel = 0; panel < panels_ && cols > 0; ++panel)
    std::copy_n(column(panel, cols), cols_ * kRows, column(panel, 0));
}

Eigen::MatrixXd RowPanels::rows(std::span<const Eigen::Index> rows) const {
  Eigen::MatrixXd gathered(static_cast<Eigen::Index>(rows.size()), cols_);
  for (std::size_t i = 0; i < rows.size(); ++i)
    gathered.row(static_cast<Eigen::Index>(i)) = row(rows[i]);
  return gathered;
}

Eigen::MatrixXd RowPanels::rows(std::span<const Eigen::Index> rows,
                                std::span<const Eigen::Index> columns) const {
  Eigen::MatrixXd gathered(static_cast<Eigen::Index>(rows.size()),
                           static_cast<Eigen::Index>(columns.size()));
  // Rows of one panel lie together in every column.
  for (std::size_t i = 0, end = 0; i < rows.size(); i = end) {
    const Eigen::Index panel = panelOf(rows[i]);
    while (end < rows.size() && panelOf(rows[end]) == panel) ++end;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const double* from = column(panel, columns[j]);
      for (std::size_t r = i; r < end; ++r)
        gathered(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(j)) =
            from[rows[r] % kRows];
    }
  }
  return gathered;
}

}  // namespace colonnade
