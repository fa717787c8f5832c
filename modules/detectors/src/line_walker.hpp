// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace colonnade {

/// An edge pixel beside a line.
struct Sample {
  double s = 0.0;       ///< along
  double across = 0.0;  ///< sub-pixel
  int sector = 0;       ///< of the gradient
};
using Samples = std::vector<Sample>;

struct SignedSamples {
  Samples rising;
  Samples falling;
};

struct Straight {
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  double across(double s) const { return offset + slope * (s - middle); }
};

/// The image seen along steep (s = row) or flat (s = column) lines.
class Walker {
 public:
  Walker(const cv::Mat& gray, const cv::Mat& edges, bool steep)
      : gray_(gray.data),
        edges_(edges.data),
        gray_s_(stride(gray, steep)),
        gray_t_(stride(gray, !steep)),
        edges_s_(stride(edges, steep)),
        edges_t_(stride(edges, !steep)),
        length_(steep ? edges.rows : edges.cols),
        width_(steep ? edges.cols : edges.rows),
        sign_of_code_(steep ? kSteep : kFlat) {}

  /// Edge pixels within `reach` of the line, the one nearest to the line in each step, apart for
  /// gradients that point along +1 and -1 across it.
  SignedSamples collect(const Straight& line, double reach) const {
    SignedSamples samples;
    samples.rising.reserve(kExpected);
    samples.falling.reserve(kExpected);
    for (int s = 1; s + 1 < length_; ++s) {
      if (isBlockStart(s) && nothingWithin(line, s, reach)) {
        s += kBlock - 1;
        continue;
      }
      const double centre = line.across(s);
      if (centre < 0.0 || centre > width_) continue;
      // Casts instead of ceil and floor, which are calls: centre - reach may be negative, but then
      // the border wins.
      const int low = std::max(2, static_cast<int>(centre - reach) + 1);
      const int high = std::min(width_ - 3, static_cast<int>(centre + reach));
      int nearest[2] = {-1, -1};
      const std::uint8_t* edge = edges_ + s * edges_s_;
      const auto consider = [&](int t, int code) {
        const int sign = sign_of_code_[code];
        if (sign == 0) return;
        int& best = nearest[sign > 0 ? 0 : 1];
        if (best < 0 || std::abs(t - centre) < std::abs(best - centre)) best = t;
      };
      if (edges_t_ == 1 && high - low < kBlock && low + kBlock <= width_) {
        for (std::uint64_t codes = word(edge + low) & firstBytes(high - low + 1); codes != 0;) {
          const int byte = std::countr_zero(codes) / 8;
          consider(low + byte, static_cast<int>(codes >> (8 * byte) & 0xff));
          codes &= ~(std::uint64_t{0xff} << (8 * byte));
        }
      } else {
        for (int t = low; t <= high; ++t)
          if (const int code = edge[t * edges_t_]; code != 0) consider(t, code);
      }
      if (nearest[0] >= 0) samples.rising.push_back(measured(s, nearest[0]));
      if (nearest[1] >= 0) samples.falling.push_back(measured(s, nearest[1]));
    }
    return samples;
  }

 private:
  static constexpr int kBlock = 8;  ///< steps looked at as one 64-bit word where columns run along
  static constexpr std::size_t kExpected = 512;

  bool isBlockStart(int s) const { return edges_s_ == 1 && s % kBlock == 1; }

  /// For flat lines: no edge pixel within reach of the line in a whole block of columns. May say
  /// false where there is none.
  bool nothingWithin(const Straight& line, int s, double reach) const {
    if (s + kBlock >= length_) return false;
    const double first = line.across(s);
    const double last = line.across(s + kBlock - 1);
    const double nearest = std::min(first, last);
    const double farthest = std::max(first, last);
    if (!(farthest >= 0.0 && nearest <= width_)) return true;
    const int low = std::max(2, static_cast<int>(nearest - reach));
    const int high = std::min(width_ - 3, static_cast<int>(farthest + reach) + 1);
    std::uint64_t any = 0;
    for (int t = low; t <= high; ++t) any |= word(edges_ + t * edges_t_ + s);
    return any == 0;
  }

  /// Eight pixels, the first one in the lowest byte.
  static std::uint64_t word(const std::uint8_t* first) {
    std::uint64_t codes;
    std::memcpy(&codes, first, sizeof codes);
    if constexpr (std::endian::native == std::endian::big) codes = __builtin_bswap64(codes);
    return codes;
  }
  static std::uint64_t firstBytes(int count) {
    if (count <= 0) return 0;
    return count >= kBlock ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * count)) - 1;
  }

  /// Which way across the line a gradient points, by edge code (0 is no edge, then the sectors).
  static constexpr int kSteep[9] = {0, 1, 1, 0, -1, -1, -1, 0, 1};
  static constexpr int kFlat[9] = {0, 0, 1, 1, 1, 0, -1, -1, -1};

  static std::ptrdiff_t stride(const cv::Mat& image, bool rows) {
    return rows ? static_cast<std::ptrdiff_t>(image.step[0]) : 1;
  }

  int gray(int s, int t) const { return gray_[s * gray_s_ + t * gray_t_]; }

  double gradient(int s, int t) const {
    return std::abs(gray(s - 1, t + 1) - gray(s - 1, t - 1) +
                    2 * (gray(s, t + 1) - gray(s, t - 1)) + gray(s + 1, t + 1) -
                    gray(s + 1, t - 1));
  }

  /// Vertex of the parabola through three gradient magnitudes, at most half a pixel away.
  Sample measured(int s, int t) const {
    const double before = gradient(s, t - 1);
    const double here = gradient(s, t);
    const double after = gradient(s, t + 1);
    const double curvature = before - 2.0 * here + after;
    const double shift =
        curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
    return {static_cast<double>(s), t + shift, edges_[s * edges_s_ + t * edges_t_] - 1};
  }

  const std::uint8_t* gray_;
  const std::uint8_t* edges_;
  std::ptrdiff_t gray_s_, gray_t_, edges_s_, edges_t_;
  int length_, width_;
  const int* sign_of_code_;
};

}  // namespace colonnade
