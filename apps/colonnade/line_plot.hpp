// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace colonnade {

/// A curve or a cloud of points of a diagram.
struct PlotSeries {
  std::string name;
  cv::Scalar colour;  ///< blue, green, red
  std::vector<cv::Point2d> points;
  bool dots = false;
};

struct LinePlot {
  std::string title, x_name, y_name;
  bool equal_axes = false;  ///< one metre as long in x as in y
  std::vector<PlotSeries> series;
  std::vector<double> x_marks;  ///< dashed vertical lines, such as the end of a round
};

/// CV_8UC3 with axes, ticks at round numbers and a legend.
cv::Mat draw(const LinePlot& plot);
/// Into a PNG file, atomically.
void writePlot(const std::filesystem::path& path, const LinePlot& plot);

}  // namespace colonnade
