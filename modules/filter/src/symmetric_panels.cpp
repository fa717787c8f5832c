// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/symmetric_panels.hpp"

#include <algorithm>

#include "panel_product.hpp"

namespace colonnade {

void SymmetricPanels::grow(Eigen::Index size) {
  size_ = std::max(size_, size);
  while (panels() * kRows < size_)
    panels_.push_back(Eigen::MatrixXd::Zero(kRows, kRows * (panels() + 1)));
}

double SymmetricPanels::operator()(Eigen::Index row, Eigen::Index column) const {
  if (row < column) std::swap(row, column);
  return panels_[static_cast<std::size_t>(row / kRows)](row % kRows, column);
}

Eigen::VectorXd SymmetricPanels::column(Eigen::Index column) const {
  Eigen::VectorXd values(panels() * kRows);
  const Eigen::Index own = column / kRows;
  values.head(column) =
      panels_[static_cast<std::size_t>(own)].row(column % kRows).head(column).transpose();
  for (Eigen::Index panel = own; panel < panels(); ++panel) {
    const Eigen::Index skipped = panel == own ? column % kRows : 0;
    values.segment(panel * kRows + skipped, kRows - skipped) =
        panels_[static_cast<std::size_t>(panel)].col(column).tail(kRows - skipped);
  }
  return values.head(size_);
}

void SymmetricPanels::setRowAndColumn(Eigen::Index index, const Eigen::VectorXd& values) {
  const Eigen::Index own = index / kRows;
  panels_[static_cast<std::size_t>(own)].row(index % kRows).head(index) =
      values.head(index).transpose();
  for (Eigen::Index panel = own; panel < panels(); ++panel) {
    const Eigen::Index first = std::max(panel * kRows, index);
    const Eigen::Index end = std::min((panel + 1) * kRows, size_);
    panels_[static_cast<std::size_t>(panel)].col(index).segment(
        first - panel * kRows, end - first) = values.segment(first, end - first);
  }
}

void SymmetricPanels::addToPanel(Eigen::Index panel, const Eigen::Ref<const Eigen::MatrixXd>& D,
                                 const Eigen::Ref<const Eigen::VectorXd>& weights) {
  static_assert(kRows == kPanelRows);
  const Eigen::Index first = panel * kRows;
  const Eigen::Index rows = std::min(kRows, size_ - first);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kRows, D.cols());
  A.topRows(rows) = D.middleRows(first, rows) * weights.asDiagonal();
  addPanelProduct(panels_[static_cast<std::size_t>(panel)].data(), first + rows, A.data(), D.data(),
                  D.outerStride(), D.cols());
}

}  // namespace colonnade
