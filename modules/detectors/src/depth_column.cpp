// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_column.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "colonnade/base/vector_kernel.hpp"
#include "colonnade/detectors/depth_noise.hpp"

namespace colonnade {
namespace {

using Floats = float __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));
using Longs = std::int64_t __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
constexpr float kBeyond = std::numeric_limits<float>::infinity();

template <class Lanes, class Number>
inline __attribute__((always_inline)) void load(Lanes& lanes, const Number* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
inline __attribute__((always_inline)) void loadAsDoubles(Doubles& lanes, const float* from) {
  Floats floats;
  load(floats, from);
  lanes = __builtin_convertvector(floats, Doubles);
}

/// The bits of positive floats are ordered as they are.
struct Split {
  int count = 0;                                             ///< up to the limit
  std::int32_t last = 0;                                     ///< of those, the greatest
  std::int32_t next = std::bit_cast<std::int32_t>(kBeyond);  ///< the least of the others
};

inline __attribute__((always_inline)) Split splitAt(const float* z, int blocks,
                                                    std::int32_t limit) {
  Split split;
  Ints count{}, last{}, next = split.next - Ints{};
  const Ints limits = limit - Ints{};
  for (int block = 0; block < blocks; ++block) {
    Ints v;
    load(v, z + block * kColumnBlock);
    const Ints up_to = v <= limits;
    count -= up_to;
    const Ints before = v & up_to;
    const Ints behind = v | (up_to & std::numeric_limits<std::int32_t>::max());
    last = before > last ? before : last;
    next = behind < next ? behind : next;
  }
  for (int i = 0; i < kColumnBlock; ++i) {
    split.count += count[i];
    split.last = std::max(split.last, last[i]);
    split.next = std::min(split.next, next[i]);
  }
  return split;
}

/// Between `least` and `most`, both among the values: guesses from how many are on each side, as if
/// they were spread evenly, and halves the interval in turn, from value to value.
inline __attribute__((always_inline)) float medianBetween(const float* z, int blocks, int pixels,
                                                          std::int32_t least, std::int32_t most) {
  const int rank = pixels / 2;
  int before = 0, up_to = pixels;  // values below `least` and up to `most`
  for (bool halve = false; least < most; halve = !halve) {
    const std::int32_t width = most - least;
    const float share =
        (static_cast<float>(rank - before) + 0.5F) / static_cast<float>(up_to - before);
    const std::int32_t way =
        halve ? width / 2 : static_cast<std::int32_t>(share * static_cast<float>(width));
    const Split split = splitAt(z, blocks, least + std::clamp(way, 0, width - 1));
    if (split.count > rank) {
      most = split.last;
      up_to = split.count;
    } else {
      least = split.next;
      before = split.count;
    }
  }
  return std::bit_cast<float>(least);
}

inline __attribute__((always_inline)) ColumnMiddle middleAround(float median, const float* z,
                                                                const double* inverse,
                                                                const float* offset, int blocks) {
  const double reach = 3.0 * kinectDepthSigma(static_cast<double>(median));
  Doubles sum{}, offsets{};
  Longs within_all{};
  for (int i = 0; i < blocks * kColumnBlock; i += 4) {
    Doubles away, q, aside;
    loadAsDoubles(away, z + i);
    load(q, inverse + i);
    loadAsDoubles(aside, offset + i);
    away -= static_cast<double>(median);
    const Longs within = (away <= reach) & (away >= -reach);
    sum += (Doubles)((Longs)q & within);
    offsets += (Doubles)((Longs)aside & within);
    within_all -= within;
  }
  ColumnMiddle middle;
  middle.median = median;
  middle.pixels = static_cast<int>(within_all[0] + within_all[1] + within_all[2] + within_all[3]);
  middle.z = middle.pixels / ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  middle.offset = ((offsets[0] + offsets[1]) + (offsets[2] + offsets[3])) / middle.pixels;
  return middle;
}

}  // namespace

void fillColumnBlock(float* z, float* offset, int pixels) {
  const int all = columnBlocks(pixels) * kColumnBlock;
  std::fill(z + pixels, z + all, kBeyond);
  std::fill(offset + pixels, offset + all, 0.0F);
}

COLONNADE_VECTOR_KERNEL
void inverseDepths(const float* z, int blocks, double* inverse) {
  for (int i = 0; i < blocks * kColumnBlock; i += 4) {
    Doubles q;
    loadAsDoubles(q, z + i);
    q = 1.0 / q;
    std::memcpy(inverse + i, &q, sizeof q);
  }
}

COLONNADE_VECTOR_KERNEL
ColumnMiddle middleOfColumn(const float* z, const double* inverse, const float* offset, int blocks,
                            int pixels, float least, float most) {
  const float median = medianBetween(z, blocks, pixels, std::bit_cast<std::int32_t>(least),
                                     std::bit_cast<std::int32_t>(most));
  return middleAround(median, z, inverse, offset, blocks);
}

COLONNADE_VECTOR_KERNEL
ColumnMiddle middleOfColumn(const float* z, const double* inverse, const float* offset, int blocks,
                            int pixels) {
  const std::int32_t beyond = std::bit_cast<std::int32_t>(kBeyond);
  Ints least = beyond - Ints{}, most{};
  for (int block = 0; block < blocks; ++block) {
    Ints v;
    load(v, z + block * kColumnBlock);
    const Ints known = v & (v < beyond);
    least = v < least ? v : least;
    most = known > most ? known : most;
  }
  std::int32_t first = least[0], last = most[0];
  for (int i = 1; i < kColumnBlock; ++i) {
    first = std::min(first, least[i]);
    last = std::max(last, most[i]);
  }
  return middleAround(medianBetween(z, blocks, pixels, first, last), z, inverse, offset, blocks);
}

}  // namespace colonnade
