// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "line_samples.hpp"
#include "step_bits.hpp"

namespace colonnade {

/// The edge pixels of an image along steep (s = row) or flat (s = column) lines, apart for
/// gradients that point along +1 and -1 across (t).
class Walker {
 public:
  /// bits: of the edges, rows as steps for steep lines, columns for flat ones.
  Walker(const cv::Mat& gray, const cv::Mat& edges, EdgeBits bits, bool steep);

  int steps() const { return length_; }

  /// Edge pixels within `reach` (up to 10) of the line, the one nearest to the line in each step;
  /// not measured yet.
  void collectAll(const Straight& line, double reach, int sign, Samples& samples);
  /// The same of those not taken yet.
  void collectFree(const Straight& line, double reach, Samples& rising, Samples& falling);
  /// Finds out where exactly the gradient of each is greatest.
  void measure(Samples& samples) const;
  void take(SampleSpan samples, int sign);
  /// Sector of an edge pixel's gradient.
  int sectorAt(double s, int t) const {
    return edges_[static_cast<std::ptrdiff_t>(s) * edges_s_ + t * edges_t_] - 1;
  }

 private:
  template <class Take>
  void eachStep(Take&& take) const;
  static int nearest(const Straight& line, int s, int low, std::uint64_t row);
  void findCorridor(const Straight& line, double reach);

  const std::uint8_t* gray_;
  std::ptrdiff_t gray_s_, gray_t_;
  const std::uint8_t* edges_;
  std::ptrdiff_t edges_s_, edges_t_;
  int length_, width_;
  EdgeBits all_;
  EdgeBits free_;                   ///< those of no line yet
  std::vector<std::int32_t> low_;   ///< t at which the corridor of a line begins, by step
  std::vector<std::int32_t> span_;  ///< its width
};

}  // namespace colonnade
