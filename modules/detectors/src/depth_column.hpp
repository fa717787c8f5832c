// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace colonnade {

/// Columns of the slice are summarised so many at a time, one in each lane of a vector.
constexpr int kColumnsTogether = 8;

/// A pixel of each of so many neighbouring columns.
struct DepthSlot {
  std::array<float, kColumnsTogether> z;       ///< m, positive; infinite where there is none
  std::array<float, kColumnsTogether> offset;  ///< of the rays from the middle of their column
};
using InverseSlot = std::array<double, kColumnsTogether>;  ///< 1 / z
using ColumnCounts = std::array<std::int32_t, kColumnsTogether>;

/// Columns stand in slots from the first on; so many hold the longest, a multiple of four.
int slotsOf(const ColumnCounts& pixels);
/// Fills the slots behind each column's pixels.
void fillSlots(DepthSlot* slots, int count, const ColumnCounts& pixels);
void inverseDepths(const DepthSlot* slots, int count, InverseSlot* inverse);

/// Part of the pixels of so many columns.
struct ColumnPart {
  const DepthSlot* slots;
  const InverseSlot* inverse;
  int count;  ///< of slots, filled
};

/// The mean inverse depth of the pixels of a column that lie within three sigma of their median.
/// Depth comes in steps of disparity that are wider than its noise averaged over a column: a median
/// would keep the steps. An upright plane is straight in inverse depth over the offset, so the
/// means of both lie on it.
struct ColumnMiddles {
  std::array<double, kColumnsTogether> z;       ///< m
  std::array<double, kColumnsTogether> offset;  ///< of the rays from the middle, columns
  std::array<float, kColumnsTogether> median;   ///< m; infinite for a column without pixels
  ColumnCounts pixels;                          ///< within; where none, the others say nothing
};
/// `pixels`: of each column in all parts together. The sums of a column have four lanes on every
/// machine, one for every fourth slot, so that their bits are the same.
ColumnMiddles middlesOfColumns(std::span<const ColumnPart> parts, const ColumnCounts& pixels);
/// The same where the median of each column is known to be within [least, most].
ColumnMiddles middlesOfColumns(std::span<const ColumnPart> parts, const ColumnCounts& pixels,
                               const std::array<float, kColumnsTogether>& least,
                               const std::array<float, kColumnsTogether>& most);

}  // namespace colonnade
