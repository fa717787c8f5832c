// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace colonnade::fixed {

/// Hysteresis in place. In each pass pixels come in raster order; a candidate becomes strong when
/// one of its eight neighbours is strong at that moment. Rows of `words_per_row` words, bit 0 of
/// word 0 is column 0; strong bits are candidates too. So strength runs on downwards and to the
/// right without bound, and one row up or one pixel to the left in each pass.
void hysteresis(const std::uint64_t* candidates, std::uint64_t* strong, int rows, int words_per_row,
                int passes);

}  // namespace colonnade::fixed
