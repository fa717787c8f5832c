// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace colonnade::fixed {

/// Pixels of room before and behind a row that kernels may read.
inline constexpr int kPad = 2;

/// One row of the 5x5 binomial Gaussian (1 4 6 4 1 in both directions, rounded, / 256).
/// rows: five rows of `width` bytes; sums: scratch of width + 2 kPad; out: width bytes with kPad
/// bytes of room on both sides, which receive copies of the border pixels.
void blurRow(const std::uint8_t* const rows[5], int width, std::uint16_t* sums, std::uint8_t* out);

/// Magnitude (the largest of the four directional 3x3 operators, thesis 2015 section 3.3) and
/// sector (direction + 4 where the operator is negative) of one row of the blurred image.
/// above, here, below: blurred rows with room; width values each.
void gradientRow(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                 int width, std::uint16_t* magnitude, std::uint16_t* sector);

/// Non-maximum suppression and thresholds of one row. magnitudes: rows above, here, below with one
/// zero before and behind. codes receives 1 + sector where the magnitude is a maximum above `low`,
/// else 0; strong the same where it is also above `high`.
void suppressRow(const std::uint16_t* above, const std::uint16_t* here, const std::uint16_t* below,
                 const std::uint16_t* sector, int width, int low, int high, std::uint8_t* codes,
                 std::uint8_t* strong);

/// Packs the bytes that are not zero into bits, column 0 lowest; the last word is filled with 0.
void packBits(const std::uint8_t* bytes, int width, std::uint64_t* words);

/// An edge pixel, from the image's centre.
struct Pixel {
  std::int16_t x;
  std::int16_t y;
};

/// bins[i] = (x cosine + y sine + offset) >> kAngleFraction of pixel i.
void rhoBins(const Pixel* pixels, int count, int cosine, int sine, int offset, std::int32_t* bins);

/// sum[i] += other[i].
void addVotes(const std::uint16_t* other, int count, std::uint16_t* sum);

/// The first place in [from, count) with at least that many votes; count if there is none.
int nextAtLeast(const std::uint16_t* votes, int from, int count, int least);

}  // namespace colonnade::fixed
