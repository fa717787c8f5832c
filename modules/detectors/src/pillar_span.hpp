// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/pillar_detector.hpp"
#include "depth_view.hpp"

namespace colonnade {

/// The rows over which an upright edge is seen, perhaps in several pieces of one line.
struct SeenSpan {
  double top = 0.0;
  double bottom = 0.0;
};

/// An upright line and what is around it.
struct UprightEdge {
  const cv::Mat& gray;
  const DepthView& depth;
  double reach_m;  ///< of depth in this frame
  const LevelledCamera& camera;
  const RefinedLine& line;
  std::optional<double> range_m;  ///< horizontal, of the edge, if known
  bool one_sided;                 ///< depth fails on one side of it
  bool may_fade;                  ///< no jump in depth, no thin line: its contrast may fade away
  const PillarOptions& options;
  int contrast;  ///< gray levels in the sense of its gradient, median over the line
};
/// Gray levels in the sense of its gradient, median over a line.
int contrastOf(const cv::Mat& gray, const RefinedLine& line);

/// The rows of a line and of all others that lie on it, above and below, with the same gradient.
/// Not what lies below the floor at the line's range, a joint or a reflection there, nor what depth
/// shows to be nearer or farther, nor what is separated from it by a gap in which neither depth nor
/// the image shows an edge: the panels of a door stand one above the other.
SeenSpan seenSpan(const UprightEdge& edge, const RefinedLines& lines);

/// Is there a stretch of these rows in which neither depth nor the image shows the edge? Of an edge
/// with a range.
bool hasGapInside(const UprightEdge& edge, const SeenSpan& span);

/// An edge of a building stands on the floor and is taller than furniture. Where it is not seen
/// down to the floor or up to `min_head_m`, something must explain that: the picture ends,
/// something nearer hides it, depth goes on to jump there, or the image keeps some of the contrast.
/// Where instead the surfaces go on without an edge, or the near one ends, it is the side of a
/// board, a panel, a table or a chair.
/// Without a range only the horizon tells, for what does not cross it cannot be both standing and
/// taller than the camera is high.
/// The contrast of a tall edge may also fade away.
struct SpanVerdict {
  std::string refusal;  ///< why it is none, or nothing
  UprightHeight height = UprightHeight::kUnknown;
};
SpanVerdict judgeSpan(const UprightEdge& edge, const SeenSpan& span);

}  // namespace colonnade
