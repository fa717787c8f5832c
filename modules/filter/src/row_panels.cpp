// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/row_panels.hpp"

namespace colonnade {

void RowPanels::growRows(Eigen::Index rows) {
  while (panels() * kRows < rows) panels_.emplace_back(static_cast<std::size_t>(kRows * cols_));
}

void RowPanels::setCols(Eigen::Index cols) {
  cols_ = cols;
  for (auto& panel : panels_) panel.resize(static_cast<std::size_t>(kRows * cols));
}

void RowPanels::dropFirstCols(Eigen::Index cols) {
  cols_ -= cols;
  for (auto& panel : panels_) panel.erase(panel.begin(), panel.begin() + kRows * cols);
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
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < columns.size(); ++j)
      gathered(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          column(panelOf(rows[i]), columns[j])[rows[i] % kRows];
  return gathered;
}

}  // namespace colonnade
