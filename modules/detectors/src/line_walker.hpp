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
  int t = 0;            ///< its pixel
  int sector = 0;       ///< of the gradient
};
using Samples = std::vector<Sample>;

struct Straight {
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  double across(double s) const { return offset + slope * (s - middle); }
};

/// The edge pixels of an image along steep (s = row) or flat (s = column) lines, apart for
/// gradients that point along +1 and -1 across (t). They are kept as bits in tiles of 8 x 8 pixels,
/// one word each, those along s side by side: a walk along a line reads little memory and skips
/// eight steps at once where nothing is near. An edge pixel is measured once, when a line first
/// passes it.
class Walker {
 public:
  Walker(const cv::Mat& gray, const cv::Mat& edges, bool steep)
      : gray_(gray.data),
        gray_s_(steep ? static_cast<std::ptrdiff_t>(gray.step[0]) : 1),
        gray_t_(steep ? 1 : static_cast<std::ptrdiff_t>(gray.step[0])),
        length_(steep ? edges.rows : edges.cols),
        width_(steep ? edges.cols : edges.rows),
        tiles_(static_cast<std::size_t>(length_ + kTile - 1) / kTile),
        shifts_(std::make_unique_for_overwrite<double[]>(edges.total())),
        codes_(std::make_unique_for_overwrite<std::uint8_t[]>(edges.total())) {
    const std::size_t size = tiles_ * (static_cast<std::size_t>(width_) / kTile + kMostTiles);
    for (auto* bits : {&rising_, &falling_, &measured_}) bits->assign(size, 0);
    setEdges(edges, steep);
    free_rising_ = rising_;
    free_falling_ = falling_;
  }

  /// Edge pixels within `reach` (up to 10) of the line, the one nearest to the line in each step.
  void collectAll(const Straight& line, double reach, int sign, Samples& samples) {
    samples.clear();
    eachBlock(line, reach, [&](const Block& block) {
      addBlock(line, reach, block, sign > 0 ? rising_ : falling_, samples);
    });
  }
  /// The same of those not taken yet.
  void collectFree(const Straight& line, double reach, Samples& rising, Samples& falling) {
    rising.clear();
    falling.clear();
    eachBlock(line, reach, [&](const Block& block) {
      addBlock(line, reach, block, free_rising_, rising);
      addBlock(line, reach, block, free_falling_, falling);
    });
  }
  void take(const Samples& samples, int sign) {
    Tiles& bits = sign > 0 ? free_rising_ : free_falling_;
    for (const auto& sample : samples) {
      const auto s = static_cast<std::size_t>(sample.s), t = static_cast<std::size_t>(sample.t);
      bits[tileOf(s, t)] &= ~bitOf(s, t);
    }
  }

 private:
  using Tiles = std::vector<std::uint64_t>;
  static constexpr int kTile = 8;
  static constexpr int kMostTiles = 8;  ///< across, that a line passes in eight steps

  /// Steps [first, end) of one row of tiles and the tiles across that the line passes there.
  struct Block {
    int first, end;
    int tile, count;
  };

  /// Which way across the line a gradient points, by edge code (0 is no edge, then the sectors).
  static constexpr int kSteep[9] = {0, 1, 1, 0, -1, -1, -1, 0, 1};
  static constexpr int kFlat[9] = {0, 0, 1, 1, 1, 0, -1, -1, -1};

  std::size_t tileOf(std::size_t s, std::size_t t) const { return t / kTile * tiles_ + s / kTile; }
  static std::uint64_t bitOf(std::size_t s, std::size_t t) {
    return std::uint64_t{1} << (s % kTile * kTile + t % kTile);
  }
  std::size_t pixelOf(std::size_t s, std::size_t t) const {
    return t * static_cast<std::size_t>(length_) + s;
  }

  void setEdges(const cv::Mat& edges, bool steep) {
    const int* const sign_of_code = steep ? kSteep : kFlat;
    const auto set = [&](int u, int v, std::uint8_t code) {
      const int sign = sign_of_code[code];
      if (sign == 0) return;
      const auto s = static_cast<std::size_t>(steep ? v : u);
      const auto t = static_cast<std::size_t>(steep ? u : v);
      (sign > 0 ? rising_ : falling_)[tileOf(s, t)] |= bitOf(s, t);
      codes_[pixelOf(s, t)] = code;
    };
    for (int v = 0; v < edges.rows; ++v) {
      const auto* row = edges.ptr<std::uint8_t>(v);
      int u = 0;
      for (; u + kTile <= edges.cols; u += kTile) {
        std::uint64_t codes;
        std::memcpy(&codes, row + u, sizeof codes);
        if (codes == 0) continue;  // most pixels are no edges
        for (int i = 0; i < kTile; ++i) set(u + i, v, row[u + i]);
      }
      for (; u < edges.cols; ++u) set(u, v, row[u]);
    }
  }

  template <class Take>
  void eachBlock(const Straight& line, double reach, Take&& take) const {
    for (int start = 0; start < length_ - 1; start += kTile) {
      const int first = std::max(start, 1), end = std::min(start + kTile, length_ - 1);
      if (first >= end) continue;
      const double a = line.across(first), b = line.across(end - 1);
      const double nearest = std::min(a, b), farthest = std::max(a, b);
      if (!(farthest >= 0.0 && nearest <= width_)) continue;
      const int low = std::max(0, static_cast<int>(nearest - reach)) / kTile;
      const int high = std::min(width_ - 1, static_cast<int>(farthest + reach) + 1) / kTile;
      if (high >= low) take(Block{first, end, low, std::min(high - low + 1, kMostTiles)});
    }
  }

  void addBlock(const Straight& line, double reach, const Block& block, const Tiles& bits,
                Samples& samples) {
    const std::uint64_t* const tile = bits.data() + static_cast<std::size_t>(block.tile) * tiles_ +
                                      static_cast<std::size_t>(block.first) / kTile;
    std::uint64_t any = 0;
    for (int i = 0; i < block.count; ++i) any |= tile[static_cast<std::size_t>(i) * tiles_];
    if (any == 0) return;
    const int origin = block.tile * kTile;
    for (int s = block.first; s < block.end; ++s) {
      const int shift = s % kTile * kTile;
      if ((any >> shift & 0xff) == 0) continue;
      const double centre = line.across(s);
      if (centre < 0.0 || centre > width_) continue;
      // Casts instead of ceil and floor, which are calls: centre - reach may be negative, but then
      // the border wins.
      const int low = std::max(2, static_cast<int>(centre - reach) + 1) - origin;
      const int high = std::min(width_ - 3, static_cast<int>(centre + reach)) - origin;
      if (high < low) continue;
      std::uint64_t row = 0;
      for (int i = 0; i < block.count; ++i)
        row |= (tile[static_cast<std::size_t>(i) * tiles_] >> shift & 0xff) << (i * kTile);
      row = row >> low << low & (~std::uint64_t{0} >> (63 - high));
      if (row != 0) add(s, centre, origin, row, samples);
    }
  }

  void add(int s, double centre, int origin, std::uint64_t row, Samples& samples) {
    int best = origin + std::countr_zero(row);
    for (row &= row - 1; row != 0; row &= row - 1) {
      const int t = origin + std::countr_zero(row);
      if (std::abs(t - centre) < std::abs(best - centre)) best = t;
    }
    const std::size_t pixel = pixelOf(static_cast<std::size_t>(s), static_cast<std::size_t>(best));
    samples.push_back({static_cast<double>(s), best + shiftAt(s, best), best, codes_[pixel] - 1});
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
    double& shift = shifts_[pixelOf(i, j)];
    std::uint64_t& tile = measured_[tileOf(i, j)];
    const std::uint64_t bit = bitOf(i, j);
    if ((tile & bit) != 0) return shift;
    tile |= bit;
    const double before = gradient(s, t - 1);
    const double here = gradient(s, t);
    const double after = gradient(s, t + 1);
    const double curvature = before - 2.0 * here + after;
    shift = curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
    return shift;
  }

  const std::uint8_t* gray_;
  std::ptrdiff_t gray_s_, gray_t_;
  int length_, width_;
  std::size_t tiles_;                      ///< along
  Tiles rising_, falling_;                 ///< edge pixels
  Tiles free_rising_, free_falling_;       ///< those of no line yet
  Tiles measured_;                         ///< those whose shift is known
  std::unique_ptr<double[]> shifts_;       ///< px from the pixel's centre; those along s together
  std::unique_ptr<std::uint8_t[]> codes_;  ///< of edge pixels, likewise
};

}  // namespace colonnade
