// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hysteresis.hpp"

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

}  // namespace

void hysteresisPass(const std::uint64_t* candidates, std::uint64_t* strong, int rows,
                    int words_per_row) {
  for (int row = 0; row < rows; ++row) {
    const std::uint64_t* mask = candidates + row * words_per_row;
    std::uint64_t* here = strong + row * words_per_row;
    std::uint64_t left = 0;  // whether the pixel left of this word is strong
    for (int i = 0; i < words_per_row; ++i) {
      if (mask[i] == 0) {
        left = 0;
        continue;
      }
      std::uint64_t seeds = spread(here, i, words_per_row).from_right;
      if (row > 0) seeds |= around(here - words_per_row, i, words_per_row);
      if (row + 1 < rows) seeds |= around(here + words_per_row, i, words_per_row);
      seeds = (seeds | here[i] | left) & mask[i];
      // Adding a seed to a run of ones carries along the run: what the sum clears is reached.
      here[i] = (mask[i] & ~(mask[i] + seeds)) | seeds;
      left = here[i] >> 63;
    }
  }
}

}  // namespace colonnade::fixed
