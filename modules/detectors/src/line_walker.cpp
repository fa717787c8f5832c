// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_walker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

/// The pixels within reach of a line, by step; none where the line leaves the image. Two pixels at
/// the border have not all neighbours.
COLONNADE_VECTOR_KERNEL
void findPixelsBeside(const Straight& line, double reach, int length, int width, std::int32_t* low,
                      std::int32_t* span) {
  const Straight l = line;
  std::int32_t* __restrict first = low;
  std::int32_t* __restrict count = span;
  const double border = width;
  for (int s = 0; s < length; ++s) {
    const double centre = l.offset + l.slope * (s - l.middle);
    const bool inside = (centre >= 0.0) & (centre <= border);
    // Casts round towards 0, but where that is up the border wins.
    const auto before = static_cast<std::int32_t>(inside ? centre - reach : 0.0) + 1;
    const auto behind = static_cast<std::int32_t>(inside ? centre + reach : 0.0);
    const std::int32_t from = before > 2 ? before : 2;
    const std::int32_t to = behind < width - 3 ? behind : width - 3;
    first[s] = from;
    count[s] = inside & (to >= from) ? to - from + 1 : 0;
  }
}

/// Vertex of the parabola through three gradient magnitudes across, at most half a pixel away.
inline __attribute__((always_inline)) double shiftAt(const std::uint8_t* here, std::ptrdiff_t along,
                                                     std::ptrdiff_t across) {
  const auto smooth = [&](std::ptrdiff_t aside) {
    const std::uint8_t* const p = here + aside * across;
    return p[-along] + 2 * p[0] + p[along];
  };
  const int sums[5] = {smooth(-2), smooth(-1), smooth(0), smooth(1), smooth(2)};
  const int before = std::abs(sums[2] - sums[0]);
  const int at = std::abs(sums[3] - sums[1]);
  const int after = std::abs(sums[4] - sums[2]);
  const int curvature = before - 2 * at + after;
  if (curvature >= 0) return 0.0;
  const double shift = 0.5 * (before - after) / curvature;
  return shift < -0.5 ? -0.5 : (shift > 0.5 ? 0.5 : shift);
}

}  // namespace

Walker::Walker(const cv::Mat& gray, const cv::Mat& edges, EdgeBits bits, bool steep)
    : gray_(gray.data),
      gray_s_(steep ? static_cast<std::ptrdiff_t>(gray.step[0]) : 1),
      gray_t_(steep ? 1 : static_cast<std::ptrdiff_t>(gray.step[0])),
      edges_(edges.data),
      edges_s_(steep ? static_cast<std::ptrdiff_t>(edges.step[0]) : 1),
      edges_t_(steep ? 1 : static_cast<std::ptrdiff_t>(edges.step[0])),
      length_(steep ? edges.rows : edges.cols),
      width_(steep ? edges.cols : edges.rows),
      all_(std::move(bits)),
      free_(all_),
      low_(static_cast<std::size_t>(length_)),
      span_(low_.size()) {}

void Walker::collectAll(const Straight& line, double reach, int sign, Samples& samples) {
  findCorridor(line, reach);
  samples.clear();
  const StepBits& bits = sign > 0 ? all_.rising : all_.falling;
  eachStep([&](int s, int low, std::uint64_t mask) {
    if (const std::uint64_t row = bits.from(s, low) & mask; row != 0)
      samples.add(s, nearest(line, s, low, row));
  });
}

void Walker::collectFree(const Straight& line, double reach, Samples& rising, Samples& falling) {
  findCorridor(line, reach);
  rising.clear();
  falling.clear();
  eachStep([&](int s, int low, std::uint64_t mask) {
    const std::uint64_t up = free_.rising.from(s, low), down = free_.falling.from(s, low);
    if (((up | down) & mask) == 0) return;
    if ((up & mask) != 0) rising.add(s, nearest(line, s, low, up & mask));
    if ((down & mask) != 0) falling.add(s, nearest(line, s, low, down & mask));
  });
}

/// Calls take(s, first pixel of the corridor, a bit for each of its pixels).
template <class Take>
void Walker::eachStep(Take&& take) const {
  for (int s = 1; s < length_ - 1; ++s) {
    const std::uint64_t mask = (std::uint64_t{1} << span_[static_cast<std::size_t>(s)]) - 1;
    take(s, low_[static_cast<std::size_t>(s)], mask);
  }
}

int Walker::nearest(const Straight& line, int s, int low, std::uint64_t row) {
  int best = low + std::countr_zero(row);
  for (row &= row - 1; row != 0; row &= row - 1) {
    const int t = low + std::countr_zero(row);
    const double centre = line.across(s);
    if (std::abs(t - centre) < std::abs(best - centre)) best = t;
  }
  return best;
}

void Walker::measure(Samples& samples, SampleSpan known) const {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [s, t] = samples.pixel(i);
    while (!known.empty() && known.s[0] < s) known = known.subspan(1);
    if (!known.empty() && known.s[0] == s && known.t[0] == t) {
      samples.setAcross(i, known.across[0]);
      continue;
    }
    const std::uint8_t* const here = gray_ + s * gray_s_ + t * gray_t_;
    // The constant step lets the compiler see that the neighbours of steep lines lie side by side.
    samples.setAcross(
        i, t + (gray_t_ == 1 ? shiftAt(here, gray_s_, 1) : shiftAt(here, gray_s_, gray_t_)));
  }
}

void Walker::take(SampleSpan samples, int sign) {
  StepBits& bits = sign > 0 ? free_.rising : free_.falling;
  for (std::size_t i = 0; i < samples.size(); ++i)
    bits.reset(static_cast<int>(samples.s[i]), samples.t[i]);
}

void Walker::findCorridor(const Straight& line, double reach) {
  findPixelsBeside(line, reach, length_, width_, low_.data(), span_.data());
}

}  // namespace colonnade
