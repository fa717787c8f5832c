// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_covariance.hpp"

#include <algorithm>

#include "panel_product.hpp"

namespace colonnade {
namespace {

/// Over so many steps, unless more columns come meanwhile.
constexpr Eigen::Index kStepsToWorkOff = 128;
/// So many columns come meanwhile, at most, as a rule.
constexpr Eigen::Index kMeanwhile = 96;
constexpr Eigen::Index kLarge = 1024;  ///< rows

}  // namespace

void RestingCovariance::grow(Eigen::Index size) {
  P_.grow(size);
  // In good time: to move the columns of a large map takes longer than a step may.
  if (size >= kLarge) owed_.reserveCols(kColumnsTogether + kMeanwhile);
  owed_.growRows(size);
}

double RestingCovariance::operator()(Eigen::Index row, Eigen::Index column) const {
  const bool paid = RowPanels::panelOf(std::max(row, column)) < panels_done_;
  const Eigen::Index owed = owed_.cols() - (paid ? paying_ : 0);
  return P_(row, column) - owed_.row(row).tail(owed).dot(owed_.row(column).tail(owed));
}

RestingCovariance::Columns RestingCovariance::columns(std::vector<Eigen::Index> ascending,
                                                      const Eigen::MatrixXd& newest) const {
  Columns columns;
  Eigen::MatrixXd minus = -owed_.rows(ascending);
  if (newest.size() > 0) minus.rightCols(newest.cols()) = -newest;
  const auto count = static_cast<Eigen::Index>(ascending.size());
  columns.in_paid_panels =
      std::count_if(ascending.begin(), ascending.end(),
                    [&](Eigen::Index index) { return RowPanels::panelOf(index) < panels_done_; });
  columns.minus_paying = Strips(minus.leftCols(paying_));
  columns.minus_unpaid = Strips(minus.leftCols(paying_).bottomRows(count - columns.in_paid_panels));
  columns.minus_later = Strips(minus.rightCols(minus.cols() - paying_));
  columns.indices = std::move(ascending);
  return columns;
}

void RestingCovariance::readRows(Eigen::Index panel, const Columns& columns, double* to) const {
  P_.readRows(panel, columns.indices, to);
  addPanelProduct(to, owed_.column(panel, paying_), columns.minus_later);
  if (panel < panels_done_)
    addPanelProduct(to + columns.in_paid_panels * SymmetricPanels::kRows, owed_.column(panel, 0),
                    columns.minus_unpaid);
  else
    addPanelProduct(to, owed_.column(panel, 0), columns.minus_paying);
}

Eigen::Index RestingCovariance::owe(Eigen::Index cols) {
  const Eigen::Index first = owed_.cols();
  owed_.setCols(first + cols);
  return first;
}

void RestingCovariance::forgive(std::span<const Eigen::Index> rows) {
  for (const Eigen::Index row : rows) {
    owed_.row(row).setZero();
    if (row < account_.rows()) account_.setZero(row);
  }
}

void RestingCovariance::openAccount() {
  paying_ = owed_.cols();
  account_.clear(paying_, P_.panels() * RowPanels::kRows);
}

void RestingCovariance::pay() {
  const auto D = owed_.panel(panels_done_).leftCols(paying_);
  account_.growRows((panels_done_ + 1) * RowPanels::kRows);
  account_.write(panels_done_ * RowPanels::kRows, D);
  P_.subtractProduct(panels_done_++, D, account_);
}

void RestingCovariance::closeAccount() {
  owed_.dropFirstCols(paying_);
  account_.clear(0, 0);
  paying_ = panels_done_ = 0;
}

void RestingCovariance::settle() {
  while (owed_.cols() > 0) {
    if (paying_ == 0) openAccount();
    while (panels_done_ < P_.panels()) pay();
    closeAccount();
  }
}

void RestingCovariance::workOff() {
  if (paying_ == 0 && owed_.cols() >= kColumnsTogether) openAccount();
  if (paying_ == 0) return;
  // Panel k has k + 1 times the work of the first.
  const Eigen::Index panels = P_.panels();
  const Eigen::Index times = 1 + (owed_.cols() - paying_) / kColumnsTogether;
  Eigen::Index budget = times * panels * (panels + 1) / 2 / kStepsToWorkOff + 1;
  for (; panels_done_ < panels && budget > 0; budget -= panels_done_) pay();
  if (panels_done_ == panels) closeAccount();
}

}  // namespace colonnade
