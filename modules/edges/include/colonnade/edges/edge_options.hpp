// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

/// Canny and Hough parameters (thesis 2015, sections 2.2 to 2.6).
struct EdgeOptions {
  static constexpr const char* kSection = "Edges";
  double canny_low = 30.0;            ///< gradient magnitude, L1 norm of the 3x3 Sobel
  double canny_high = 80.0;
  double smoothing_sigma_px = 0.8;
  double vertical_tolerance = radians(12.0);
  int vertical_votes_percent = 12;    ///< of the image height
  int inclined_votes_percent = 14;    ///< of the image height
  int max_lines = 60;                 ///< of each class

  void visit(OptionVisitor& v) {
    v.number("canny_low", canny_low, {1, 2000}, "lower hysteresis threshold of Canny");
    v.number("canny_high", canny_high, {1, 2000}, "upper hysteresis threshold of Canny");
    v.number("smoothing_sigma_px", smoothing_sigma_px, {0, 5}, "Gaussian before Canny");
    v.angle("vertical_tolerance_deg", vertical_tolerance, {1, 30}, "from the image's vertical");
    v.integer("vertical_votes_percent", vertical_votes_percent, {2, 100}, "of the image height");
    v.integer("inclined_votes_percent", inclined_votes_percent, {2, 100}, "of the image height");
    v.integer("max_lines", max_lines, {1, 1000}, "kept of each class, best first");
  }
};

}  // namespace colonnade
