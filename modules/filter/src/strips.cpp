// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/strips.hpp"

#include <algorithm>

namespace colonnade {

void Strips::write(Eigen::Index first, const Rows& rows) {
  for (Eigen::Index r = 0, count = 0; r < rows.rows(); r += count) {
    count = std::min(kWidth - (first + r) % kWidth, rows.rows() - r);
    double* to = row(first + r);
    for (Eigen::Index k = 0; k < depth_; ++k)
      std::copy_n(rows.data() + k * rows.outerStride() + r, count, to + k * kWidth);
    Eigen::Index& zero = zero_columns_[static_cast<std::size_t>((first + r) / kWidth)];
    Eigen::Index k = 0;
    while (k < zero && rows.col(k).segment(r, count).isZero(0.0)) ++k;
    zero = k;
  }
}

void Strips::setZero(Eigen::Index index) {
  double* to = row(index);
  for (Eigen::Index k = 0; k < depth_; ++k) to[k * kWidth] = 0.0;
}

}  // namespace colonnade
