// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "colonnade/base/options.hpp"

namespace colonnade {

/// The known shade of pillars (thesis 2015, section 2.4): three closed ranges. In hsv the first is
/// hue in degrees (0 to 360; a range whose low end is the larger one runs through 0), the others
/// saturation and value from 0 to 255; in rgb they are red, green and blue.
struct ShadeOptions {
  static constexpr const char* kSection = "Shade";
  std::string space = "none";  ///< none: pillars of any shade
  double first_low = 0.0, first_high = 360.0;
  double second_low = 0.0, second_high = 255.0;
  double third_low = 0.0, third_high = 255.0;

  void visit(OptionVisitor& v) {
    v.choice("space", space, {"none", "hsv", "rgb"}, "what the ranges are in; none: any shade");
    v.number("first_low", first_low, {0, 360}, "hue in degrees, or red");
    v.number("first_high", first_high, {0, 360}, "hue below first_low: through 0");
    v.number("second_low", second_low, {0, 255}, "saturation, or green");
    v.number("second_high", second_high, {0, 255}, "saturation, or green");
    v.number("third_low", third_low, {0, 255}, "value, or blue");
    v.number("third_high", third_high, {0, 255}, "value, or blue");
  }
  bool known() const { return space != "none"; }
};

/// Is a mean colour (B, G, R, 0 to 255) of the known shade? Always where none is known.
bool hasShade(const Eigen::Vector3f& bgr, const ShadeOptions& shade);

/// The shade of a rectangle of a picture that shows nothing but a pillar: in each channel the
/// middle nine tenths of its pixels, widened by `margin` (0 to 255) for other light. Gray surfaces,
/// whose hue is noise, get all hues. colour: CV_8UC3. Throws Error where the rectangle is empty or
/// leaves the picture.
ShadeOptions learnShade(const cv::Mat& colour, const cv::Rect& area,
                        const std::string& space = "hsv", double margin = 25.0);

}  // namespace colonnade
