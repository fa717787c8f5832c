// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hysteresis.hpp"

#include <vector>

namespace colonnade::fixed {
namespace {

/// Word i of a row with its neighbours to the left and to the right.
struct Spread {
  std::uint64_t from_left;   ///< bit u: the pixel at u - 1
  std::uint64_t from_right;  ///< bit u: the pixel at u + 1
  std::uint64_t here;
};

Spread spread(const std::uint64_t* row, int i, int words) {
  const std::uint64_t here = row[i];
  return {here << 1 | (i > 0 ? row[i - 1] >> 63 : 0),
          here >> 1 | (i + 1 < words ? row[i + 1] << 63 : 0), here};
}

std::uint64_t around(const std::uint64_t* row, int i, int words) {
  const Spread s = spread(row, i, words);
  return s.from_left | s.from_right | s.here;
}

/// One row of a pass; whether it changed.
bool passRow(const std::uint64_t* mask, std::uint64_t* here, bool has_above, bool has_below,
             int words) {
  std::uint64_t left = 0;  // whether the pixel left of this word is strong
  std::uint64_t gained = 0;
  for (int i = 0; i < words; ++i) {
    if (mask[i] == 0) {
      left = 0;
      continue;
    }
    const std::uint64_t former = here[i];
    std::uint64_t seeds = spread(here, i, words).from_right;
    if (has_above) seeds |= around(here - words, i, words);
    if (has_below) seeds |= around(here + words, i, words);
    seeds = (seeds | former | left) & mask[i];
    // Adding a seed to a run of ones carries along the run: what the sum clears is reached.
    here[i] = (mask[i] & ~(mask[i] + seeds)) | seeds;
    gained |= here[i] ^ former;
    left = here[i] >> 63;
  }
  return gained != 0;
}

}  // namespace

void hysteresis(const std::uint64_t* candidates, std::uint64_t* strong, int rows, int words_per_row,
                int passes) {
  // A row can only change where it or one beside it has changed since it was last looked at: in the
  // pass before it and the row below, in this one the row above. So later passes leave out most
  // rows. A row beyond the last one never changes.
  std::vector<std::uint8_t> changed(static_cast<std::size_t>(rows) + 1, 1);
  changed.back() = 0;
  for (int pass = 0; pass < passes; ++pass) {
    bool above_changed = false;
    for (int row = 0; row < rows; ++row) {
      auto* const here = &changed[static_cast<std::size_t>(row)];
      if (above_changed || here[0] || here[1])
        above_changed = passRow(candidates + row * words_per_row, strong + row * words_per_row,
                                row > 0, row + 1 < rows, words_per_row);
      else
        above_changed = false;
      here[0] = above_changed ? 1 : 0;
    }
  }
}

}  // namespace colonnade::fixed
