// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "row_kernels.hpp"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

#include "colonnade/base/vector_kernel.hpp"
#include "colonnade/edges/angle_table.hpp"

// Plain loops over rows that the compiler turns into vectors, for wider vectors where the machine
// has them. Integers only: every variant gives the same bits.

namespace colonnade::fixed {

COLONNADE_VECTOR_KERNEL
void blurRow(const std::uint8_t* const rows[5], int width, std::uint16_t* sums, std::uint8_t* out) {
  const std::uint8_t* __restrict a = rows[0];
  const std::uint8_t* __restrict b = rows[1];
  const std::uint8_t* __restrict c = rows[2];
  const std::uint8_t* __restrict d = rows[3];
  const std::uint8_t* __restrict e = rows[4];
  std::uint16_t* __restrict sum = sums + kPad;
  for (int i = 0; i < width; ++i) {
    sum[i] = static_cast<std::uint16_t>(a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i]);
  }
  for (int i = 1; i <= kPad; ++i) {
    sum[-i] = sum[0];
    sum[width - 1 + i] = sum[width - 1];
  }
  const std::uint16_t* __restrict s = sum;
  std::uint8_t* __restrict o = out;
  for (int i = 0; i < width; ++i) {
    const auto total = static_cast<std::uint16_t>(s[i - 2] + s[i + 2] + 4 * (s[i - 1] + s[i + 1]) +
                                                  6 * s[i] + 128);
    o[i] = static_cast<std::uint8_t>(total >> 8);
  }
  for (int i = 1; i <= kPad; ++i) {
    out[-i] = out[0];
    out[width - 1 + i] = out[width - 1];
  }
}

COLONNADE_VECTOR_KERNEL
void gradientRow(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                 int width, std::uint16_t* magnitude, std::uint16_t* sector) {
  const std::uint8_t* __restrict p = above;
  const std::uint8_t* __restrict c = here;
  const std::uint8_t* __restrict n = below;
  std::uint16_t* __restrict m = magnitude;
  std::uint16_t* __restrict s = sector;
  for (int i = 0; i < width; ++i) {
    // All four operators from the differences of opposite neighbours.
    const auto across = static_cast<std::int16_t>(c[i + 1] - c[i - 1]);
    const auto down = static_cast<std::int16_t>(n[i] - p[i]);
    const auto to_se = static_cast<std::int16_t>(n[i + 1] - p[i - 1]);
    const auto to_sw = static_cast<std::int16_t>(n[i - 1] - p[i + 1]);
    const auto along_u = static_cast<std::int16_t>(to_se - to_sw + across);
    const auto along_v = static_cast<std::int16_t>(to_se + to_sw + down);
    const auto falling = static_cast<std::int16_t>(to_se + down + across);
    const auto rising = static_cast<std::int16_t>(to_sw + down - across);
    // Equal magnitudes: u before v before the diagonals.
    std::int16_t best = static_cast<std::int16_t>(along_u < 0 ? -along_u : along_u);
    std::int16_t code = along_u < 0 ? 4 : 0;
    const auto v = static_cast<std::int16_t>(along_v < 0 ? -along_v : along_v);
    code = v > best ? (along_v < 0 ? 6 : 2) : code;
    best = v > best ? v : best;
    const auto f = static_cast<std::int16_t>(falling < 0 ? -falling : falling);
    code = f > best ? (falling < 0 ? 5 : 1) : code;
    best = f > best ? f : best;
    const auto r = static_cast<std::int16_t>(rising < 0 ? -rising : rising);
    code = r > best ? (rising < 0 ? 7 : 3) : code;
    best = r > best ? r : best;
    m[i] = static_cast<std::uint16_t>(best);
    s[i] = static_cast<std::uint16_t>(code);
  }
}

COLONNADE_VECTOR_KERNEL
void suppressRow(const std::uint16_t* above, const std::uint16_t* here, const std::uint16_t* below,
                 const std::uint16_t* sector, int width, int low, int high, std::uint8_t* codes,
                 std::uint8_t* strong) {
  const std::uint16_t* __restrict p = above;
  const std::uint16_t* __restrict c = here;
  const std::uint16_t* __restrict n = below;
  const std::uint16_t* __restrict s = sector;
  std::uint8_t* __restrict code = codes;
  std::uint8_t* __restrict above_high = strong;
  const auto least = static_cast<std::uint16_t>(low);
  const auto enough = static_cast<std::uint16_t>(high);
  for (int i = 0; i < width; ++i) {
    // All eight neighbours are read, whatever the direction: a load under a condition is no vector.
    const std::uint16_t m = c[i], left = c[i - 1], right = c[i + 1];
    const std::uint16_t nw = p[i - 1], north = p[i], ne = p[i + 1];
    const std::uint16_t sw = n[i - 1], south = n[i], se = n[i + 1];
    const auto direction = static_cast<std::uint16_t>(s[i] & 3);
    std::uint16_t before = direction == 1 ? nw : left;
    std::uint16_t behind = direction == 1 ? se : right;
    before = direction == 2 ? north : before;
    behind = direction == 2 ? south : behind;
    before = direction == 3 ? ne : before;
    behind = direction == 3 ? sw : behind;
    auto kept = static_cast<std::uint16_t>(m > least ? s[i] + 1 : 0);
    kept = m > before ? kept : std::uint16_t{0};
    kept = m >= behind ? kept : std::uint16_t{0};
    code[i] = static_cast<std::uint8_t>(kept);
    above_high[i] = static_cast<std::uint8_t>(m > enough ? kept : std::uint16_t{0});
  }
}

COLONNADE_VECTOR_KERNEL
void rhoBins(const Pixel* pixels, int count, int cosine, int sine, int offset, std::int32_t* bins) {
  const Pixel* __restrict at = pixels;
  std::int32_t* __restrict out = bins;
  for (int i = 0; i < count; ++i) {
    out[i] = (at[i].x * cosine + at[i].y * sine + offset) >> kAngleFraction;
  }
}

COLONNADE_VECTOR_KERNEL
void addVotes(const std::uint16_t* other, int count, std::uint16_t* sum) {
  const std::uint16_t* __restrict more = other;
  std::uint16_t* __restrict to = sum;
  for (int i = 0; i < count; ++i) to[i] = static_cast<std::uint16_t>(to[i] + more[i]);
}

COLONNADE_VECTOR_KERNEL
int nextAtLeast(const std::uint16_t* votes, int from, int count, int least) {
  constexpr int kBlock = 64;
  for (; from + kBlock <= count; from += kBlock) {
    std::uint16_t most = 0;
    for (int i = 0; i < kBlock; ++i) most = std::max(most, votes[from + i]);
    if (most >= least) break;
  }
  while (from < count && votes[from] < least) ++from;
  return from;
}

void packBits(const std::uint8_t* bytes, int width, std::uint64_t* words) {
  using Lanes = cv::v_uint8x16;
  for (int start = 0; start < width; start += 64) {
    std::uint64_t word = 0;
    const int end = std::min(64, width - start);
    int i = 0;
    for (; i + Lanes::nlanes <= end; i += Lanes::nlanes) {
      const Lanes set = cv::v_load(bytes + start + i) != cv::v_setzero_u8();
      word |= static_cast<std::uint64_t>(static_cast<std::uint32_t>(cv::v_signmask(set))) << i;
    }
    for (; i < end; ++i) word |= static_cast<std::uint64_t>(bytes[start + i] != 0) << i;
    words[start / 64] = word;
  }
}

}  // namespace colonnade::fixed
