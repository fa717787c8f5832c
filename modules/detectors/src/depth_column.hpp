// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace colonnade {

/// The mean inverse depth of the pixels of a column that lie within three sigma of their median.
/// Depth comes in steps of disparity that are wider than its noise averaged over a column: a median
/// would keep the steps. An upright plane is straight in inverse depth over the offset, so the
/// means of both lie on it.
struct ColumnMiddle {
  double z = 0.0;       ///< m
  double offset = 0.0;  ///< of the rays from the middle of their column, columns
  float median = 0.0F;  ///< m
  int pixels = 0;       ///< within
};

/// The pixels of a column stand in whole blocks; beyond the last one follows what is farther than
/// all.
constexpr int kColumnBlock = 8;
constexpr int columnBlocks(int pixels) { return (pixels + kColumnBlock - 1) / kColumnBlock; }
/// Fills the last block behind so many pixels.
void fillColumnBlock(float* z, float* offset, int pixels);

/// inverse[i] = 1 / z[i].
void inverseDepths(const float* z, int blocks, double* inverse);

/// Of `blocks` blocks that hold `pixels` pixels, at least one. z is positive, inverse as above. The
/// sums have four lanes on every machine, so that their bits are the same.
ColumnMiddle middleOfColumn(const float* z, const double* inverse, const float* offset, int blocks,
                            int pixels);
/// The same where the median is known to be within [least, most].
ColumnMiddle middleOfColumn(const float* z, const double* inverse, const float* offset, int blocks,
                            int pixels, float least, float most);

}  // namespace colonnade
