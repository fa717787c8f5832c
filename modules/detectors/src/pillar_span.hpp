// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "colonnade/detectors/pillar_detector.hpp"
#include "depth_view.hpp"

namespace colonnade {

/// The rows over which an upright edge is seen, perhaps in several pieces of one line.
struct SeenSpan {
  double top = 0.0;
  double bottom = 0.0;
};

/// An edge of a building stands on the floor and is taller than furniture. Where it is not seen
/// down to the floor or up to `min_head_m`, something must explain that: the picture ends,
/// something nearer hides it, depth goes on to jump there, or the image keeps some of the contrast.
/// Where instead the surfaces go on without an edge, or the near one ends, it is the side of a
/// board, a panel, a table or a chair.
/// range_m: horizontal, of the edge; empty: only the horizon tells, for what does not cross it
/// cannot be both standing and taller than the camera is high.
/// Returns why it is none, or nothing.
std::string reasonAgainstSpan(const cv::Mat& gray, const DepthView& depth,
                              const LevelledCamera& camera, const RefinedLine& line,
                              const SeenSpan& span, std::optional<double> range_m,
                              const PillarOptions& options);

/// Mean gray levels beside a line, by distance from it, in the sense of its gradient: they rise at
/// 0.
class AcrossProfile {
 public:
  static constexpr int kReach_px = 20;
  AcrossProfile(const cv::Mat& gray, const RefinedLine& line);

  /// The gentle slope of a shade on a wall, such as in a corner or of a lamp, and no edge: the
  /// gradient stays above half of its peak over many pixels.
  bool isShade() const;
  /// One side of a line of up to this width with the same shade on both sides of it.
  bool isThinLine(int width_px) const;

 private:
  double at(int k) const { return sums_[static_cast<std::size_t>(k + kReach_px)]; }
  std::array<double, 2 * kReach_px + 1> sums_{};
};

}  // namespace colonnade
