// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/detectors/segmentation.hpp"
#include "depth_cells.hpp"

namespace colonnade {

/// Least squares: inverse depth over columns, linear on a plane.
class InverseDepthLine {
 public:
  void add(int column, float z_m) {
    if (count_ == 0.0) origin_ = column;
    const double x = column - origin_, q = 1.0 / static_cast<double>(z_m);
    count_ += 1.0;
    x_ += x;
    q_ += q;
    xx_ += x * x;
    xq_ += x * q;
  }
  /// Depth at a column, metres; not positive beyond the horizon.
  double at(int column) const {
    const double spread = count_ * xx_ - x_ * x_;
    const double slope = spread > 0.0 ? (count_ * xq_ - x_ * q_) / spread : 0.0;
    return 1.0 / ((q_ - slope * x_) / count_ + slope * (column - origin_));
  }
  int count() const { return static_cast<int>(count_); }

 private:
  int origin_ = 0;
  double count_ = 0.0, x_ = 0.0, q_ = 0.0, xx_ = 0.0, xq_ = 0.0;
};

/// Cells of a row that lie on one straight line in plan.
struct StraightPiece {
  int first = 0, end = 0;  ///< columns
  InverseDepthLine line;
  double length_m = 0.0;
};

/// Cuts a row of cells where its depth jumps or bends; what has fewer than three cells is left out.
std::vector<StraightPiece> straightPieces(const DepthCells& cells, int row,
                                          const SegmentationOptions& options);

}  // namespace colonnade
