// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

#include "colonnade/detectors/refined_line.hpp"

namespace colonnade {

/// Mean gray levels beside a line, by distance from it along u (steep lines) or v (flat ones), in
/// the sense of its gradient: they rise at 0.
class AcrossProfile {
 public:
  static constexpr int kReach_px = 20;
  AcrossProfile(const cv::Mat& gray, const RefinedLine& line);

  /// Between the half heights of the gradient to both sides of its peak, px: blur gives a sharp
  /// edge 2 or 3, the shade of a lamp or in a corner has more.
  double width() const;
  /// The greatest rise from one pixel to the next near the line, gray levels.
  double steepest() const;
  /// One side of a line of up to this width with the same shade on both sides of it.
  bool isThinLine(int width_px) const;

 private:
  void addUpFlat(const cv::Mat& gray, const RefinedLine& line);
  double rise(int k) const { return at(k + 1) - at(k); }  ///< between k and k + 1
  int peak() const;                                       ///< where it rises most, near the line
  double at(int k) const { return sums_[static_cast<std::size_t>(k + kReach_px)]; }
  std::array<double, 2 * kReach_px + 1> sums_{};
};

}  // namespace colonnade
