// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/edges/angle_table.hpp"

namespace colonnade {

/// What is built into the hardware: its parameters at elaboration.
struct FixedShape {
  /// Ascending whole degrees in [-90, 89]; neighbours 1 or 2 degrees apart compete for a line.
  std::vector<int> angles_deg;
  int hysteresis_passes = 4;  ///< each delays the stream by one line; 0: the high threshold alone
};

/// What a frame is processed with: the run-time registers (hdl/REGISTERS.md).
struct FixedParameters {
  int low = 22;  ///< gradient magnitude, 0 to 1023; an edge is above, not at, the threshold
  int high = 60;
  int vertical_votes = 30;      ///< least votes of a line of class 0
  int inclined_votes = 30;      ///< and of class 1
  int vertical_from_deg = -10;  ///< angles of class 0, inclusive
  int vertical_to_deg = 10;
  int first_row = 0;          ///< edges above this row do not vote for class 1
  std::vector<bool> enabled;  ///< one for each angle of the shape; empty: all
};

/// One word of the line packet: x cos(theta) + y sin(theta) = rho with x, y in whole pixels from
/// the pixel (width / 2, height / 2).
struct FixedLine {
  int theta_deg = 0;
  int rho = 0;
  int votes = 0;
  int line_class = 0;  ///< 0 vertical, 1 inclined
  bool operator==(const FixedLine&) const = default;
};

struct FixedResult {
  cv::Mat edges;                 ///< CV_8UC1 as EdgeLines::edges
  std::vector<FixedLine> lines;  ///< by angle, then rho
};

/// rho bins of an image run from -rhoReach to rhoReach.
int rhoReach(int width_px, int height_px);

/// Canny and Hough in the integer arithmetic of hdl/README.md: the model the RTL is compared with
/// bit for bit, and the fast image stage on a CPU. Keeps its buffers between frames.
class FixedStage {
 public:
  /// Throws Error for angles out of range or order.
  explicit FixedStage(FixedShape shape);
  /// gray: CV_8UC1, not empty.
  FixedResult process(const cv::Mat& gray, const FixedParameters& parameters);
  const FixedShape& shape() const { return shape_; }

 private:
  FixedShape shape_;
  std::vector<unsigned short> votes_;
};

}  // namespace colonnade
