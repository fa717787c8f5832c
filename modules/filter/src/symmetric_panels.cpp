// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/symmetric_panels.hpp"

#include <algorithm>

#include "panel_product.hpp"

namespace colonnade {

void SymmetricPanels::grow(Eigen::Index size) {
  panels_ = std::max(panels_, (size + kRows - 1) / kRows);
  while (static_cast<Eigen::Index>(groups_.size()) * kTogether < panels_) {
    const std::size_t side = (groups_.size() + 1) * static_cast<std::size_t>(kTogether * kRows);
    groups_.emplace_back(side * static_cast<std::size_t>(kTogether * kRows));
  }
}

double SymmetricPanels::operator()(Eigen::Index row, Eigen::Index column) const {
  if (row < column) std::swap(row, column);
  return tile(row / kRows, column)[row % kRows];
}

void SymmetricPanels::readRows(Eigen::Index panel, std::span<const Eigen::Index> columns,
                               double* to) const {
  for (const Eigen::Index column : columns) {
    const Eigen::Index own = column / kRows;
    if (own <= panel) {
      std::copy_n(tile(panel, column), kRows, to);
    } else {
      const double* from = tile(own, panel * kRows) + column % kRows;
      for (Eigen::Index row = 0; row < kRows; ++row) to[row] = from[row * kRows];
    }
    to += kRows;
  }
}

void SymmetricPanels::writeRows(Eigen::Index panel, std::span<const Eigen::Index> columns,
                                const double* from) {
  for (const Eigen::Index column : columns) {
    const Eigen::Index own = column / kRows;
    if (own <= panel) std::copy_n(from, kRows, tile(panel, column));
    if (own >= panel) {
      double* to = tile(own, panel * kRows) + column % kRows;
      for (Eigen::Index row = 0; row < kRows; ++row) to[row * kRows] = from[row];
    }
    from += kRows;
  }
}

void SymmetricPanels::subtractProduct(Eigen::Index panel,
                                      const Eigen::Ref<const Eigen::MatrixXd>& A, const Strips& B) {
  static_assert(kRows == kPanelRows);
  const Eigen::MatrixXd minus_A = -A;
  addPanelProduct(tile(panel, 0), (panel + 1) * kRows, minus_A.data(), B);
}

}  // namespace colonnade
