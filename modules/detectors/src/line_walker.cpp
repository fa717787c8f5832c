// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_walker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

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

}  // namespace

Walker::Walker(const cv::Mat& gray, const cv::Mat& edges, bool steep)
    : gray_(gray.data),
      gray_s_(steep ? static_cast<std::ptrdiff_t>(gray.step[0]) : 1),
      gray_t_(steep ? 1 : static_cast<std::ptrdiff_t>(gray.step[0])),
      edges_(edges.data),
      edges_s_(steep ? static_cast<std::ptrdiff_t>(edges.step[0]) : 1),
      edges_t_(steep ? 1 : static_cast<std::ptrdiff_t>(edges.step[0])),
      length_(steep ? edges.rows : edges.cols),
      width_(steep ? edges.cols : edges.rows),
      all_(edgeBits(edges, steep)),
      free_(all_),
      low_(static_cast<std::size_t>(length_)),
      span_(low_.size()) {}

void Walker::collectAll(const Straight& line, double reach, int sign, Samples& samples) {
  findCorridor(line, reach);
  collect(line, sign > 0 ? all_.rising : all_.falling, samples);
}

void Walker::collectFree(const Straight& line, double reach, Samples& rising, Samples& falling) {
  findCorridor(line, reach);
  collect(line, free_.rising, rising);
  collect(line, free_.falling, falling);
}

void Walker::collect(const Straight& line, const StepBits& bits, Samples& samples) const {
  samples.clear();
  for (int s = 1; s < length_ - 1; ++s) {
    const int low = low_[static_cast<std::size_t>(s)];
    const int span = span_[static_cast<std::size_t>(s)];
    std::uint64_t row = bits.from(s, low) & ((std::uint64_t{1} << span) - 1);
    if (row == 0) continue;
    int best = low + std::countr_zero(row);
    for (row &= row - 1; row != 0; row &= row - 1) {
      const int t = low + std::countr_zero(row);
      const double centre = line.across(s);
      if (std::abs(t - centre) < std::abs(best - centre)) best = t;
    }
    samples.add(s, best);
  }
}

void Walker::measure(Samples& samples) const {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [s, t] = samples.pixel(i);
    samples.setAcross(i, t + shiftOf(s, t));
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

/// Vertex of the parabola through three gradient magnitudes, at most half a pixel away.
double Walker::shiftOf(int s, int t) const {
  const std::uint8_t* const here = gray_ + s * gray_s_ + t * gray_t_;
  const auto smooth = [&](std::ptrdiff_t aside) {
    const std::uint8_t* const p = here + aside * gray_t_;
    return p[-gray_s_] + 2 * p[0] + p[gray_s_];
  };
  const int column[5] = {smooth(-2), smooth(-1), smooth(0), smooth(1), smooth(2)};
  const int before = std::abs(column[2] - column[0]);
  const int at = std::abs(column[3] - column[1]);
  const int after = std::abs(column[4] - column[2]);
  const int curvature = before - 2 * at + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

}  // namespace colonnade
