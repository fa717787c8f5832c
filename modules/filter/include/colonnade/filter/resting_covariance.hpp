// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "colonnade/filter/row_panels.hpp"
#include "colonnade/filter/strips.hpp"
#include "colonnade/filter/symmetric_panels.hpp"

namespace colonnade {

/// The covariance of all that rests with all that rests, the one thing of a large map that is
/// large. What it loses when landmarks are exchanged is of low rank, and owed as such: P lacks
/// -D D^T. What several exchanges owe is paid together, a few panels at a time, by workOff(). The
/// functions that read count what is owed.
class RestingCovariance {
 public:
  Eigen::Index panels() const { return P_.panels(); }
  void grow(Eigen::Index size);

  double operator()(Eigen::Index row, Eigen::Index column) const;
  /// Some columns, to be read panel by panel. Outlives no change of what is owed.
  struct Columns {
    std::vector<Eigen::Index> indices;  ///< ascending
    Eigen::Index in_paid_panels = 0;    ///< so many of the first lie in panels already paid
    /// Their rows of D, with the sign turned: the columns that are being paid, ...
    Strips minus_paying;
    /// ... the same but for what lies in panels already paid (a product starts with a strip), ...
    Strips minus_unpaid;
    Strips minus_later;  ///< ... and all other columns.
  };
  /// `newest`: their rows of the last columns of D, where those are not filled in yet.
  Columns columns(std::vector<Eigen::Index> ascending, const Eigen::MatrixXd& newest = {}) const;
  /// The rows of one panel: SymmetricPanels::kRows x indices.size(), by columns.
  void readRows(Eigen::Index panel, const Columns& columns, double* to) const;
  void writeRows(Eigen::Index panel, std::span<const Eigen::Index> columns, const double* from) {
    P_.writeRows(panel, columns, from);
  }

  /// D gets so many more columns, zero yet, to be filled through owed(). Returns the first.
  Eigen::Index owe(Eigen::Index cols);
  RowPanels& owed() { return owed_; }
  /// Nothing is owed to these rows: they are written now, or leave.
  void forgive(std::span<const Eigen::Index> rows);
  /// A part of the work.
  void workOff();
  /// All of it.
  void settle();

 private:
  void openAccount();
  void pay();
  void closeAccount();

  SymmetricPanels P_;
  /// So many columns of the debt are paid together. Until then they cost time only where columns of
  /// P are read that were not written since.
  static constexpr Eigen::Index kColumnsTogether = 256;
  RowPanels owed_{32};            ///< D; grows
  Eigen::Index paying_ = 0;       ///< so many of its first columns are paid ...
  Eigen::Index panels_done_ = 0;  ///< ... in so many of the first panels
  Strips account_;                ///< those columns of those panels
};

}  // namespace colonnade
