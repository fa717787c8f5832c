// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "colonnade/base/vector_kernel.hpp"
#include "lanes.hpp"

namespace colonnade {
namespace {

// Sums in four lanes on every machine, so that their bits are the same.
using Lanes = double __attribute__((vector_size(32)));
constexpr std::size_t kLanes = 4;

inline __attribute__((always_inline)) double total(const Lanes& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

struct Means {
  double s = 0.0, across = 0.0;
};
COLONNADE_VECTOR_KERNEL
Means meansOf(const double* s, const double* across, std::size_t count) {
  Lanes sum_s{}, sum_across{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes a, b;
    load(a, s + i);
    load(b, across + i);
    sum_s += a;
    sum_across += b;
  }
  Means sums{total(sum_s), total(sum_across)};
  for (; i < count; ++i) {
    sums.s += s[i];
    sums.across += across[i];
  }
  const auto n = static_cast<double>(count);
  return {sums.s / n, sums.across / n};
}

struct Moments {
  double ss = 0.0, st = 0.0;
};
COLONNADE_VECTOR_KERNEL
Moments momentsAbout(const Means& means, const double* s, const double* across, std::size_t count) {
  Lanes sum_ss{}, sum_st{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes a, b;
    load(a, s + i);
    load(b, across + i);
    a -= means.s;
    sum_ss += a * a;
    sum_st += a * (b - means.across);
  }
  Moments sums{total(sum_ss), total(sum_st)};
  for (; i < count; ++i) {
    const double a = s[i] - means.s;
    sums.ss += a * a;
    sums.st += a * (across[i] - means.across);
  }
  return sums;
}

COLONNADE_VECTOR_KERNEL
double squaresAbout(const Straight& line, const double* s, const double* across,
                    std::size_t count) {
  const Straight l = line;
  Lanes sum{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Lanes a, b;
    load(a, s + i);
    load(b, across + i);
    b -= l.offset + l.slope * (a - l.middle);
    sum += b * b;
  }
  double squares = total(sum);
  for (; i < count; ++i) {
    const double residual = across[i] - l.across(s[i]);
    squares += residual * residual;
  }
  return squares;
}

/// How many are nearer to the line than `reach`, or, kClosed, not farther.
template <bool kClosed>
inline __attribute__((always_inline)) std::int64_t countNear(const Straight& line, double reach,
                                                             const double* s, const double* across,
                                                             std::size_t count) {
  const Straight l = line;
  std::int64_t near = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = across[i] - (l.offset + l.slope * (s[i] - l.middle));
    const bool is_near =
        kClosed ? (off <= reach) & (off >= -reach) : (off < reach) & (off > -reach);
    near += is_near ? 1 : 0;
  }
  return near;
}

COLONNADE_VECTOR_KERNEL
int countBlock(const Straight& line, double reach, const double* s, const double* across,
               std::size_t count) {
  return static_cast<int>(countNear<false>(line, reach, s, across, count));
}

COLONNADE_VECTOR_KERNEL
bool areWithin(const Straight& line, double reach, const double* s, const double* across,
               std::size_t count) {
  return countNear<true>(line, reach, s, across, count) == static_cast<std::int64_t>(count);
}

}  // namespace

void Samples::assignWithin(SampleSpan some, const Straight& line, double reach) {
  constexpr std::size_t kBlock = 32;
  std::size_t kept = 0;
  for (SampleSpan rest = some; !rest.empty();) {
    const SampleSpan block = rest.first(std::min(kBlock, rest.size()));
    rest = rest.subspan(block.size());
    // Most blocks are kept whole: to see that takes fewer steps than to choose one by one.
    if (areWithin(line, reach, block.s, block.across, block.size())) {
      if (block.s != &s_[kept]) {
        std::copy_n(block.s, block.size(), &s_[kept]);
        std::copy_n(block.across, block.size(), &across_[kept]);
        std::copy_n(block.t, block.size(), &t_[kept]);
      }
      kept += block.size();
      continue;
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
      const double s = block.s[i], across = block.across[i];
      s_[kept] = s;
      across_[kept] = across;
      t_[kept] = block.t[i];
      kept += std::abs(across - line.across(s)) <= reach ? 1U : 0U;
    }
  }
  count_ = kept;
}

void Samples::assign(SampleSpan some) {
  std::copy_n(some.s, some.count, s_.data());
  std::copy_n(some.across, some.count, across_.data());
  std::copy_n(some.t, some.count, t_.data());
  count_ = some.count;
}

std::optional<LineFit> leastSquares(SampleSpan samples) {
  if (samples.size() < 3) return std::nullopt;
  const Means means = meansOf(samples.s, samples.across, samples.count);
  const Moments moments = momentsAbout(means, samples.s, samples.across, samples.count);
  if (moments.ss <= 0.0) return std::nullopt;
  return LineFit{{means.s, means.across, moments.st / moments.ss},
                 static_cast<double>(samples.size()),
                 moments.ss};
}

double sumOfSquaredResiduals(SampleSpan samples, const Straight& line) {
  return squaresAbout(line, samples.s, samples.across, samples.count);
}

int countWithin(SampleSpan samples, const Straight& line, double reach, int beat) {
  constexpr std::size_t kBlock = 64;
  int count = 0;
  for (std::size_t first = 0; first < samples.size(); first += kBlock) {
    const SampleSpan rest = samples.subspan(first);
    if (count + static_cast<int>(rest.size()) <= beat) break;
    count += countBlock(line, reach, rest.s, rest.across, std::min(kBlock, rest.size()));
  }
  return count;
}

}  // namespace colonnade
