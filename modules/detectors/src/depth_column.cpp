// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_column.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "colonnade/base/vector_kernel.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "lanes.hpp"

namespace colonnade {
namespace {

constexpr int kSums = 4;                     ///< of every fourth slot
constexpr int kHalf = kColumnsTogether / 2;  ///< columns that are summed together
constexpr float kBeyond = std::numeric_limits<float>::infinity();

using Ints = std::int32_t __attribute__((vector_size(4 * kColumnsTogether)));
using Floats = float __attribute__((vector_size(4 * kColumnsTogether)));
using HalfFloats = float __attribute__((vector_size(4 * kHalf)));
using HalfInts = std::int32_t __attribute__((vector_size(4 * kHalf)));
using Doubles = double __attribute__((vector_size(8 * kHalf)));
using Longs = std::int64_t __attribute__((vector_size(8 * kHalf)));

inline __attribute__((always_inline)) void loadAsDoubles(Doubles& lanes, const float* from) {
  HalfFloats floats;
  load(floats, from);
  lanes = __builtin_convertvector(floats, Doubles);
}
inline __attribute__((always_inline)) bool anyOf(const Ints& mask) {
  static_assert(kColumnsTogether == 8);
  std::int64_t words[kColumnsTogether / 2];
  store(mask, words);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// By column. The bits of positive floats are ordered as they are.
struct Medians {
  Ints least, most;
};

/// The least and the greatest pixel of each column; +infinity and 0 for none.
inline __attribute__((always_inline)) void findLimits(std::span<const ColumnPart> parts,
                                                      Medians& limits) {
  const std::int32_t beyond = std::bit_cast<std::int32_t>(kBeyond);
  limits.least = beyond - Ints{};
  limits.most = Ints{};
  for (const ColumnPart& part : parts)
    for (int i = 0; i < part.count; ++i) {
      Ints v;
      load(v, part.slots[i].z.data());
      const Ints known = v & (v < beyond);
      limits.least = v < limits.least ? v : limits.least;
      limits.most = known > limits.most ? known : limits.most;
    }
}

/// Closes in on the medians, which lie between `least` and `most`: guesses from how many are on
/// each side, as if they were spread evenly, and halves the interval in turn, from value to value.
/// All columns go the same number of rounds; those that are done stay.
inline __attribute__((always_inline)) void closeIn(std::span<const ColumnPart> parts,
                                                   const Ints& pixels, Medians& medians) {
  Ints &least = medians.least, &most = medians.most;
  const Ints rank = pixels / 2;
  Ints before{}, up_to = pixels;  // values below `least` and up to `most`
  for (bool halve = false;; halve = !halve) {
    const Ints open = least < most;
    if (!anyOf(open)) return;
    const Ints width = most - least;
    Ints way = width / 2;
    if (!halve) {
      const Floats share = (__builtin_convertvector(rank - before, Floats) + 0.5F) /
                           __builtin_convertvector(up_to - before, Floats);
      const Floats guess = share * __builtin_convertvector(width, Floats);
      way = __builtin_convertvector(open ? guess : Floats{}, Ints);
      way = way < width - 1 ? way : width - 1;
      way = way > 0 ? way : Ints{};
    }
    const Ints limit = least + way;
    Ints count{}, last{}, next = std::bit_cast<std::int32_t>(kBeyond) - Ints{};
    for (const ColumnPart& part : parts)
      for (int i = 0; i < part.count; ++i) {
        Ints v;
        load(v, part.slots[i].z.data());
        const Ints within = v <= limit;
        count -= within;
        const Ints low = v & within;
        const Ints high = v | (within & std::numeric_limits<std::int32_t>::max());
        last = low > last ? low : last;    // of those up to the limit, the greatest
        next = high < next ? high : next;  // the least of the others
      }
    const Ints is_low = open & (count > rank), is_high = open & ~is_low;
    most = is_low ? last : most;
    up_to = is_low ? count : up_to;
    least = is_high ? next : least;
    before = is_high ? count : before;
  }
}

/// Of the columns from `first` on.
inline __attribute__((always_inline)) void averageAround(std::span<const ColumnPart> parts,
                                                         int first, ColumnMiddles& middles) {
  Doubles median, reach;
  for (int i = 0; i < kHalf; ++i) {
    median[i] = static_cast<double>(middles.median[static_cast<std::size_t>(first + i)]);
    reach[i] = 3.0 * kinectDepthSigma(median[i]);
  }
  Doubles sums[kSums] = {}, offsets[kSums] = {};
  Longs within_all{};
  for (const ColumnPart& part : parts)
    for (int i = 0; i < part.count; i += kSums)
      for (int k = 0; k < kSums; ++k) {
        Doubles away, q, aside;
        loadAsDoubles(away, part.slots[i + k].z.data() + first);
        load(q, part.inverse[i + k].data() + first);
        loadAsDoubles(aside, part.slots[i + k].offset.data() + first);
        away -= median;
        const Longs within = (away <= reach) & (away >= -reach);
        sums[k] += (Doubles)((Longs)q & within);
        offsets[k] += (Doubles)((Longs)aside & within);
        within_all -= within;
      }
  const Doubles pixels = __builtin_convertvector(within_all, Doubles);
  store(pixels / ((sums[0] + sums[1]) + (sums[2] + sums[3])), middles.z.data() + first);
  store(((offsets[0] + offsets[1]) + (offsets[2] + offsets[3])) / pixels,
        middles.offset.data() + first);
  store(__builtin_convertvector(within_all, HalfInts), middles.pixels.data() + first);
}

inline __attribute__((always_inline)) ColumnMiddles middlesBetween(
    std::span<const ColumnPart> parts, const ColumnCounts& pixels, Medians& medians) {
  Ints counts;
  load(counts, pixels.data());
  closeIn(parts, counts, medians);
  ColumnMiddles middles;
  store(medians.least, middles.median.data());
  for (int first = 0; first < kColumnsTogether; first += kHalf)
    averageAround(parts, first, middles);
  return middles;
}

}  // namespace

int slotsOf(const ColumnCounts& pixels) {
  const int most = *std::max_element(pixels.begin(), pixels.end());
  return (most + kSums - 1) / kSums * kSums;
}

void fillSlots(DepthSlot* slots, int count, const ColumnCounts& pixels) {
  for (std::size_t column = 0; column < pixels.size(); ++column)
    for (int i = pixels[column]; i < count; ++i) {
      slots[i].z[column] = kBeyond;
      slots[i].offset[column] = 0.0F;
    }
}

COLONNADE_VECTOR_KERNEL
void inverseDepths(const DepthSlot* slots, int count, InverseSlot* inverse) {
  for (int i = 0; i < count; ++i)
    for (int first = 0; first < kColumnsTogether; first += kHalf) {
      Doubles q;
      loadAsDoubles(q, slots[i].z.data() + first);
      store(1.0 / q, inverse[i].data() + first);
    }
}

COLONNADE_VECTOR_KERNEL
ColumnMiddles middlesOfColumns(std::span<const ColumnPart> parts, const ColumnCounts& pixels,
                               const std::array<float, kColumnsTogether>& least,
                               const std::array<float, kColumnsTogether>& most) {
  Medians medians;
  load(medians.least, least.data());
  load(medians.most, most.data());
  return middlesBetween(parts, pixels, medians);
}

COLONNADE_VECTOR_KERNEL
ColumnMiddles middlesOfColumns(std::span<const ColumnPart> parts, const ColumnCounts& pixels) {
  Medians medians;
  findLimits(parts, medians);
  return middlesBetween(parts, pixels, medians);
}

}  // namespace colonnade
