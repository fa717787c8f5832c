// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/detectors/short_segment_detector.hpp"

namespace colonnade {

/// u = offset + slope (v - middle), between two rows; sign +1: brighter on its right.
struct UprightSegment {
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  int top = 0;
  int bottom = 0;
  int sign = 0;
  double across(double v) const { return offset + slope * (v - middle); }
  double length() const { return bottom - top; }
};

/// All segments of the edge map that are long and straight enough, by their upper ends.
std::vector<UprightSegment> uprightSegments(const cv::Mat& edges,
                                            const ShortSegmentOptions& options);

}  // namespace colonnade
