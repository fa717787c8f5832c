// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
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

struct Straight {
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  double across(double s) const { return offset + slope * (s - middle); }
};

/// The edge pixels of an image along steep (s = row) or flat (s = column) lines: for each step s a
/// row of bits across (t), apart for gradients that point along +1 and -1 across. An edge pixel is
/// measured once, when a line first passes it, however many lines do.
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
        words_(static_cast<std::size_t>(width_) / kWord + 2),
        shifts_(std::make_unique_for_overwrite<double[]>(edges.total())) {
    const std::size_t size = static_cast<std::size_t>(length_) * words_;
    for (auto& bits : bits_) bits.assign(size, 0);
    measured_.assign(size, 0);
    blocks_.assign(static_cast<std::size_t>(length_ / kBlock + 1) * words_, 0);
    setBits(edges, steep);
  }

  /// Edge pixels within `reach` (up to 10) of the line, the one nearest to the line in each step.
  void collect(const Straight& line, double reach, int sign, Samples& samples) {
    samples.clear();
    each(line, reach, [&](int s, double centre, int low, std::uint64_t mask) {
      add(s, centre, low, window(bits_[sign > 0 ? 0 : 1], s, low) & mask, samples);
    });
  }
  void collect(const Straight& line, double reach, Samples& rising, Samples& falling) {
    rising.clear();
    falling.clear();
    each(line, reach, [&](int s, double centre, int low, std::uint64_t mask) {
      add(s, centre, low, window(bits_[0], s, low) & mask, rising);
      add(s, centre, low, window(bits_[1], s, low) & mask, falling);
    });
  }

 private:
  static constexpr std::size_t kWord = 64;
  static constexpr int kBlock = 8;  ///< steps that are skipped at once where nothing is near

  /// Which way across the line a gradient points, by edge code (0 is no edge, then the sectors).
  static constexpr int kSteep[9] = {0, 1, 1, 0, -1, -1, -1, 0, 1};
  static constexpr int kFlat[9] = {0, 0, 1, 1, 1, 0, -1, -1, -1};

  static std::ptrdiff_t stride(const cv::Mat& image, bool rows) {
    return rows ? static_cast<std::ptrdiff_t>(image.step[0]) : 1;
  }

  void setBits(const cv::Mat& edges, bool steep) {
    const int* const sign_of_code = steep ? kSteep : kFlat;
    const auto set = [&](int u, int v, int code) {
      const int sign = sign_of_code[code];
      if (sign == 0) return;
      const auto s = static_cast<std::size_t>(steep ? v : u);
      const auto t = static_cast<std::size_t>(steep ? u : v);
      const std::uint64_t bit = std::uint64_t{1} << (t % kWord);
      bits_[sign > 0 ? 0 : 1][s * words_ + t / kWord] |= bit;
      blocks_[s / kBlock * words_ + t / kWord] |= bit;
    };
    for (int v = 0; v < edges.rows; ++v) {
      const auto* row = edges.ptr<std::uint8_t>(v);
      constexpr int kAtOnce = 8;  // most pixels are no edges
      int u = 0;
      for (; u + kAtOnce <= edges.cols; u += kAtOnce) {
        std::uint64_t codes;
        std::memcpy(&codes, row + u, sizeof codes);
        if (codes == 0) continue;
        for (int i = 0; i < kAtOnce; ++i)
          if (row[u + i] != 0) set(u + i, v, row[u + i]);
      }
      for (; u < edges.cols; ++u) set(u, v, row[u]);
    }
  }

  /// 64 bits from t = low on.
  std::uint64_t window(const std::vector<std::uint64_t>& bits, int s, int low) const {
    const auto at = static_cast<std::size_t>(low);
    const std::uint64_t* const word =
        bits.data() + static_cast<std::size_t>(s) * words_ + at / kWord;
    const std::size_t shift = at % kWord;
    return word[0] >> shift | word[1] << 1 << (kWord - 1 - shift);
  }

  /// Calls take(s, where the line crosses, first t within reach, mask of those within reach).
  template <class Take>
  void each(const Straight& line, double reach, Take&& take) {
    for (int s = 1; s + 1 < length_;) {
      const int end = std::min((s / kBlock + 1) * kBlock, length_ - 1);
      if (isEmpty(line, s, end, reach)) {
        s = end;
        continue;
      }
      for (; s < end; ++s) {
        const double centre = line.across(s);
        if (centre < 0.0 || centre > width_) continue;
        // Casts instead of ceil and floor, which are calls: centre - reach may be negative, but
        // then the border wins.
        const int low = std::max(2, static_cast<int>(centre - reach) + 1);
        const int high = std::min(width_ - 3, static_cast<int>(centre + reach));
        if (high >= low) take(s, centre, low, (std::uint64_t{2} << (high - low)) - 1);
      }
    }
  }

  /// No edge pixel lies within reach in a block of steps [first, end). May say false nevertheless.
  bool isEmpty(const Straight& line, int first, int end, double reach) const {
    const double a = line.across(first), b = line.across(end - 1);
    const double nearest = std::min(a, b), farthest = std::max(a, b);
    if (!(farthest >= 0.0 && nearest <= width_)) return true;
    const int low = std::max(2, static_cast<int>(nearest - reach));
    const int high = std::min(width_ - 3, static_cast<int>(farthest + reach) + 1);
    if (high < low) return true;
    if (high - low >= static_cast<int>(kWord)) return false;
    return (window(blocks_, first / kBlock, low) & ((std::uint64_t{2} << (high - low)) - 1)) == 0;
  }

  void add(int s, double centre, int low, std::uint64_t near, Samples& samples) {
    if (near == 0) return;
    int best = low + std::countr_zero(near);
    for (near &= near - 1; near != 0; near &= near - 1) {
      const int t = low + std::countr_zero(near);
      if (std::abs(t - centre) < std::abs(best - centre)) best = t;
    }
    samples.push_back({static_cast<double>(s), best + shiftAt(s, best),
                       edges_[s * edges_s_ + best * edges_t_] - 1});
  }

  int gray(int s, int t) const { return gray_[s * gray_s_ + t * gray_t_]; }

  double gradient(int s, int t) const {
    return std::abs(gray(s - 1, t + 1) - gray(s - 1, t - 1) +
                    2 * (gray(s, t + 1) - gray(s, t - 1)) + gray(s + 1, t + 1) -
                    gray(s + 1, t - 1));
  }

  /// Vertex of the parabola through three gradient magnitudes, at most half a pixel away.
  double shiftAt(int s, int t) {
    const auto i = static_cast<std::size_t>(s), j = static_cast<std::size_t>(t);
    // Steps along a line lie side by side.
    double& shift = shifts_[j * static_cast<std::size_t>(length_) + i];
    std::uint64_t& word = measured_[i * words_ + j / kWord];
    const std::uint64_t bit = std::uint64_t{1} << (j % kWord);
    if ((word & bit) != 0) return shift;
    word |= bit;
    const double before = gradient(s, t - 1);
    const double here = gradient(s, t);
    const double after = gradient(s, t + 1);
    const double curvature = before - 2.0 * here + after;
    shift = curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
    return shift;
  }

  const std::uint8_t* gray_;
  const std::uint8_t* edges_;
  std::ptrdiff_t gray_s_, gray_t_, edges_s_, edges_t_;
  int length_, width_;
  std::size_t words_;                    ///< of a step, one more than needed
  std::vector<std::uint64_t> bits_[2];   ///< edge pixels, rising and falling
  std::vector<std::uint64_t> blocks_;    ///< edge pixels of either sign in kBlock steps
  std::vector<std::uint64_t> measured_;  ///< whose shift is known
  std::unique_ptr<double[]> shifts_;     ///< px from the pixel's centre, by (t, s)
};

}  // namespace colonnade
