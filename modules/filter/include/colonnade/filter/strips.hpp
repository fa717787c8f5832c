// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/base/memory.hpp"

namespace colonnade {

/// A matrix in strips of six rows, each strip by columns: six columns of a product fill the
/// registers of a processor with AVX2, and what they are multiplied with is read from one end to
/// the other. The last strip is filled up with zeros.
class Strips {
 public:
  static constexpr Eigen::Index kWidth = 6;
  using Rows = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  Strips() = default;
  explicit Strips(const Rows& matrix) : Strips(matrix.rows(), matrix.cols()) { write(0, matrix); }
  Strips(Eigen::Index rows, Eigen::Index depth) : depth_(depth) { growRows(rows); }

  Eigen::Index rows() const { return rows_; }
  Eigen::Index depth() const { return depth_; }
  /// The first columns of a strip, so many, are zero.
  Eigen::Index zeroColumns(Eigen::Index index) const {
    return zero_columns_[static_cast<std::size_t>(index)];
  }
  /// depth() columns of kWidth.
  const double* strip(Eigen::Index index) const { return strips_.data() + index * kWidth * depth_; }
  /// Without rows, but with room for so many.
  void clear(Eigen::Index depth, Eigen::Index rows) {
    strips_.clear();
    zero_columns_.clear();
    rows_ = 0;
    depth_ = depth;
    strips_.reserve(static_cast<std::size_t>((rows + kWidth) * depth));
  }
  /// New rows are zero.
  void growRows(Eigen::Index rows) {
    rows_ = rows;
    const auto strips = static_cast<std::size_t>((rows + kWidth - 1) / kWidth);
    strips_.resize(strips * static_cast<std::size_t>(kWidth * depth_));
    zero_columns_.resize(strips, depth_);
  }
  void write(Eigen::Index first, const Rows& rows);
  void setZero(Eigen::Index row);

 private:
  double* row(Eigen::Index row) {
    return strips_.data() + row / kWidth * kWidth * depth_ + row % kWidth;
  }
  Eigen::Index rows_ = 0;
  Eigen::Index depth_ = 0;
  std::vector<double, LargeAllocator<double>> strips_;
  std::vector<Eigen::Index> zero_columns_;
};

}  // namespace colonnade
