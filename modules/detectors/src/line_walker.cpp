// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_walker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
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

/// Gradient magnitudes before, at and after a pixel, across a line; averaged along it.
struct Gradients {
  std::int16_t before, at, after, unused;
};

inline __attribute__((always_inline)) Gradients gradientsAt(const std::uint8_t* here,
                                                            std::ptrdiff_t along,
                                                            std::ptrdiff_t across) {
  const auto smooth = [&](std::ptrdiff_t aside) {
    const std::uint8_t* const p = here + aside * across;
    return p[-along] + 2 * p[0] + p[along];
  };
  const int sums[5] = {smooth(-2), smooth(-1), smooth(0), smooth(1), smooth(2)};
  const auto magnitude = [&](int i) {
    return static_cast<std::int16_t>(std::abs(sums[i + 2] - sums[i]));
  };
  return {magnitude(0), magnitude(1), magnitude(2), 0};
}

/// The same where pixels across lie side by side; reads three columns more.
inline __attribute__((always_inline)) Gradients gradientsInRow(const std::uint8_t* here,
                                                               std::ptrdiff_t along) {
  using Bytes = std::uint8_t __attribute__((vector_size(8)));
  using Sums = std::int16_t __attribute__((vector_size(16)));
  Bytes above, middle, below;
  std::memcpy(&above, here - along - 2, sizeof above);
  std::memcpy(&middle, here - 2, sizeof middle);
  std::memcpy(&below, here + along - 2, sizeof below);
  const Sums sums = __builtin_convertvector(above, Sums) +
                    2 * __builtin_convertvector(middle, Sums) +
                    __builtin_convertvector(below, Sums);
  const Sums steps = __builtin_shufflevector(sums, sums, 2, 3, 4, 5, 6, 7, 0, 1) - sums;
  const Sums magnitudes = steps < 0 ? -steps : steps;
  Gradients gradients;
  std::memcpy(&gradients, &magnitudes, sizeof gradients);
  return gradients;
}

COLONNADE_VECTOR_KERNEL
void findGradientsInRows(const std::uint8_t* gray, std::ptrdiff_t along, int width,
                         SampleSpan samples, Gradients* gradients) {
  constexpr int kRead = 5;  // columns behind the pixel
  for (std::size_t i = 0; i < samples.count; ++i) {
    const int t = samples.t[i];
    const std::uint8_t* const here = gray + static_cast<std::ptrdiff_t>(samples.s[i]) * along + t;
    gradients[i] = t + kRead < width ? gradientsInRow(here, along) : gradientsAt(here, along, 1);
  }
}

/// Vertices of the parabolas through the gradients, at most half a pixel away from the pixels.
COLONNADE_VECTOR_KERNEL
void findVertices(const Gradients* gradients, const int* t, std::size_t count, double* across) {
  const Gradients* __restrict g = gradients;
  const int* __restrict pixel = t;
  double* __restrict out = across;
  for (std::size_t i = 0; i < count; ++i) {
    const int curvature = g[i].before - 2 * g[i].at + g[i].after;
    const double vertex = 0.5 * (g[i].before - g[i].after) / (curvature < 0 ? curvature : -1);
    const double limited = vertex < -0.5 ? -0.5 : (vertex > 0.5 ? 0.5 : vertex);
    out[i] = pixel[i] + (curvature < 0 ? limited : 0.0);
  }
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

void Walker::measure(Samples& samples) const {
  constexpr std::size_t kBlock = 64;
  Gradients gradients[kBlock];
  double* across = samples.across();
  for (SampleSpan rest = samples; !rest.empty();) {
    const SampleSpan some = rest.first(std::min(kBlock, rest.size()));
    if (gray_t_ == 1)
      findGradientsInRows(gray_, gray_s_, width_, some, gradients);
    else
      for (std::size_t i = 0; i < some.size(); ++i)
        gradients[i] = gradientsAt(
            gray_ + static_cast<std::ptrdiff_t>(some.s[i]) + some.t[i] * gray_t_, 1, gray_t_);
    findVertices(gradients, some.t, some.size(), across);
    across += some.size();
    rest = rest.subspan(some.size());
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
