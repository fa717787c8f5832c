// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_covariance.hpp"

#include <algorithm>

#include "panel_product.hpp"

namespace colonnade {
namespace {

/// Over so many steps, unless more columns come meanwhile.
constexpr Eigen::Index kStepsToWorkOff = 32;

}  // namespace

void RestingCovariance::grow(Eigen::Index size) {
  P_.grow(size);
  owed_.growRows(size);
}

double RestingCovariance::operator()(Eigen::Index row, Eigen::Index column) const {
  const bool paid = RowPanels::panelOf(std::max(row, column)) < panels_done_;
  const Eigen::Index owed = owed_.cols() - (paid ? paying_ : 0);
  return P_(row, column) - owed_.row(row).tail(owed).dot(owed_.row(column).tail(owed));
}

RestingCovariance::Columns RestingCovariance::columns(std::vector<Eigen::Index> ascending) const {
  Columns columns;
  columns.minus_owed = -owed_.rows(ascending);
  columns.in_paid_panels =
      std::count_if(ascending.begin(), ascending.end(),
                    [&](Eigen::Index index) { return RowPanels::panelOf(index) < panels_done_; });
  columns.indices = std::move(ascending);
  return columns;
}

void RestingCovariance::readRows(Eigen::Index panel, const Columns& columns, double* to) const {
  P_.readRows(panel, columns.indices, to);
  const auto count = static_cast<Eigen::Index>(columns.indices.size());
  const auto subtract = [&](Eigen::Index first, Eigen::Index cols, Eigen::Index skipped) {
    addPanelProduct(to + skipped * SymmetricPanels::kRows, count - skipped,
                    owed_.column(panel, first), columns.minus_owed.data() + first * count + skipped,
                    count, cols);
  };
  subtract(paying_, owed_.cols() - paying_, 0);
  subtract(0, paying_, panel < panels_done_ ? columns.in_paid_panels : 0);
}

Eigen::Index RestingCovariance::owe(Eigen::Index cols) {
  const Eigen::Index first = owed_.cols();
  owed_.setCols(first + cols);
  return first;
}

void RestingCovariance::forgive(std::span<const Eigen::Index> rows) {
  for (const Eigen::Index row : rows) owed_.row(row).setZero();
}

void RestingCovariance::pay() { P_.subtractSquare(panels_done_++, owed_, paying_); }

void RestingCovariance::closeAccount() {
  owed_.dropFirstCols(paying_);
  paying_ = panels_done_ = 0;
}

void RestingCovariance::settle() {
  for (int account = 0; account < 2; ++account) {
    while (paying_ > 0 && panels_done_ < P_.panels()) pay();
    closeAccount();
    paying_ = owed_.cols();
  }
  paying_ = 0;
}

void RestingCovariance::workOff() {
  if (paying_ == 0 && owed_.cols() >= kColumnsTogether) paying_ = owed_.cols();
  if (paying_ == 0) return;
  // Panel k has k + 1 times the work of the first.
  const Eigen::Index panels = P_.panels();
  const Eigen::Index times = 1 + (owed_.cols() - paying_) / kColumnsTogether;
  Eigen::Index budget = times * panels * (panels + 1) / 2 / kStepsToWorkOff + 1;
  for (; panels_done_ < panels && budget > 0; budget -= panels_done_) pay();
  if (panels_done_ == panels) closeAccount();
}

}  // namespace colonnade
