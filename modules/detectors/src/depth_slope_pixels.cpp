// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_slope_pixels.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kNearest_m = 0.2;
constexpr double kFarthest_m = 15.0;

double colourDistance(const cv::Mat& colour, int v, int u, int other) {
  const auto& a = colour.at<cv::Vec3b>(v, u);
  const auto& b = colour.at<cv::Vec3b>(v, other);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Mean of a gray image as a share of white.
double brightnessOf(const cv::Mat& gray) {
  if (gray.empty()) return 0.0;
  double sum = 0.0;
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u) sum += gray.at<std::uint8_t>(v, u);
  return sum / (255.0 * static_cast<double>(gray.total()));
}

}  // namespace

std::vector<SlopePixel> findSlopePixels(const Frame& frame, double threshold,
                                        const SlopePixelOptions& options) {
  std::vector<SlopePixel> found;
  const cv::Mat& depth_m = frame.depth_m;
  if (depth_m.empty() || depth_m.type() != CV_32FC1) return found;
  const bool has_colour = frame.colour.type() == CV_8UC3 && frame.colour.size() == depth_m.size();
  const double alpha = has_colour && options.colour_share > 0.0 && frame.gray.type() == CV_8UC1
                           ? options.colour_share * brightnessOf(frame.gray)
                           : 0.0;
  const int rows = std::min(options.rows, depth_m.rows);
  std::vector<int> measured;
  for (int k = 0; k < rows; ++k) {
    const int v = depth_m.rows * (2 * k + 1) / (2 * rows);
    const float* z_m = depth_m.ptr<float>(v);
    measured.clear();
    for (int u = 0; u < depth_m.cols; ++u)
      if (z_m[u] > static_cast<float>(kNearest_m) && z_m[u] < static_cast<float>(kFarthest_m))
        measured.push_back(u);  // false for NaN, too
    for (std::size_t i = 1; i + 1 < measured.size(); ++i) {
      const int left = measured[i - 1], u = measured[i], right = measured[i + 1];
      const double z = static_cast<double>(z_m[u]);
      if (z < options.min_depth_m || z > options.max_depth_m) continue;
      const double to_left = static_cast<double>(z_m[left]) - z;
      const double to_right = static_cast<double>(z_m[right]) - z;
      if (std::min(to_left, to_right) < 0.0 || std::max(to_left, to_right) <= 0.0) continue;
      const double left_slope = -1000.0 * to_left / (u - left);
      const double right_slope = 1000.0 * to_right / (right - u);
      double weight = (1.0 - alpha) * std::abs(right_slope - left_slope);
      if (alpha > 0.0)
        weight += alpha * std::max(colourDistance(frame.colour, v, u, left),
                                   colourDistance(frame.colour, v, u, right));
      if (weight > threshold) found.push_back({u, v, z, weight});
    }
  }
  return found;
}

}  // namespace colonnade
