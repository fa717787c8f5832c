// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "row_kernels.hpp"

#include <algorithm>
#include <cstring>

#include "colonnade/edges/angle_table.hpp"

// Plain loops over rows that the compiler turns into vectors, for wider vectors where the machine
// has them. Integers only: every variant gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define COLONNADE_VECTOR_KERNEL __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define COLONNADE_VECTOR_KERNEL
#endif

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
    const auto along_u =
        static_cast<std::int16_t>(p[i + 1] + c[i + 1] + n[i + 1] - p[i - 1] - c[i - 1] - n[i - 1]);
    const auto along_v =
        static_cast<std::int16_t>(n[i - 1] + n[i] + n[i + 1] - p[i - 1] - p[i] - p[i + 1]);
    const auto falling =
        static_cast<std::int16_t>(n[i] + n[i + 1] + c[i + 1] - p[i - 1] - p[i] - c[i - 1]);
    const auto rising =
        static_cast<std::int16_t>(n[i - 1] + n[i] + c[i - 1] - p[i] - p[i + 1] - c[i + 1]);
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
    const auto direction = static_cast<std::uint16_t>(s[i] & 3);
    std::uint16_t before = c[i - 1];
    std::uint16_t behind = c[i + 1];
    before = direction == 1 ? p[i - 1] : before;
    behind = direction == 1 ? n[i + 1] : behind;
    before = direction == 2 ? p[i] : before;
    behind = direction == 2 ? n[i] : behind;
    before = direction == 3 ? p[i + 1] : before;
    behind = direction == 3 ? n[i - 1] : behind;
    const std::uint16_t m = c[i];
    const std::uint16_t kept = (m > least) & (m > before) & (m >= behind);
    code[i] = static_cast<std::uint8_t>(kept ? s[i] + 1 : 0);
    above_high[i] = static_cast<std::uint8_t>(kept & (m > enough));
  }
}

COLONNADE_VECTOR_KERNEL
void rhoBins(const std::int16_t* x, const std::int16_t* y, int count, int cosine, int sine,
             int offset, std::int32_t* bins) {
  const std::int16_t* __restrict px = x;
  const std::int16_t* __restrict py = y;
  std::int32_t* __restrict out = bins;
  for (int i = 0; i < count; ++i) {
    out[i] = (px[i] * cosine + py[i] * sine + offset) >> kAngleFraction;
  }
}

void packBits(const std::uint8_t* bytes, int width, std::uint64_t* words) {
  for (int start = 0; start < width; start += 64) {
    std::uint64_t word = 0;
    const int end = std::min(64, width - start);
    int i = 0;
    for (; i + 8 <= end; i += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, bytes + start + i,
                  8);  // byte 0 lowest: little endian, as everywhere here
      if (eight == 0) continue;
      // Any bit of a byte to its lowest bit, then the eight of them side by side.
      eight |= eight >> 4;
      eight |= eight >> 2;
      eight |= eight >> 1;
      eight &= 0x0101010101010101U;
      word |= (eight * 0x0102040810204080U >> 56) << i;
    }
    for (; i < end; ++i) word |= static_cast<std::uint64_t>(bytes[start + i] != 0) << i;
    words[start / 64] = word;
  }
}

}  // namespace colonnade::fixed
