// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opencv_backend.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "line_selection.hpp"
#include "sectors.hpp"

namespace colonnade {
namespace {

constexpr int kHalfTurn = 180;  // degrees
std::vector<HoughLine> houghLines(const cv::Mat& edges, const EdgeOptions& options) {
  const int vertical_votes = std::max(1, edges.rows * options.vertical_votes_percent / 100);
  const int inclined_votes = std::max(1, edges.rows * options.inclined_votes_percent / 100);
  std::vector<cv::Vec3f> peaks;  // rho, theta, votes
  cv::HoughLines(edges, peaks, 1.0, CV_PI / kHalfTurn, std::min(vertical_votes, inclined_votes) - 1,
                 0.0, 0.0, 0.0, CV_PI);
  std::vector<HoughLine> lines;
  lines.reserve(peaks.size());
  for (const auto& peak : peaks) {
    HoughLine line;
    line.theta_index =
        static_cast<int>(std::lround(static_cast<double>(peak[1]) * kHalfTurn / CV_PI));
    line.rho_bin = static_cast<int>(std::lround(peak[0]));
    line.votes = static_cast<int>(std::lround(peak[2]));
    if (line.theta_index >= kHalfTurn) {
      line.theta_index -= kHalfTurn;
      line.rho_bin = -line.rho_bin;
    }
    const double from_vertical = radians(std::min(line.theta_index, kHalfTurn - line.theta_index));
    const bool vertical = from_vertical <= options.vertical_tolerance;
    line.line_class = vertical ? LineClass::kVertical : LineClass::kInclined;
    if (line.votes >= (vertical ? vertical_votes : inclined_votes)) lines.push_back(line);
  }
  return selectLines(std::move(lines), options.max_lines);
}

}  // namespace

EdgeLines OpencvBackend::process(const cv::Mat& gray, const EdgeView& /*view*/) {
  EdgeLines result;
  cv::Mat smooth;  // of its own: an output that shares the input's pixels would be blurred in place
  if (options_.smoothing_sigma_px > 0.0) {
    cv::GaussianBlur(gray, smooth, {}, options_.smoothing_sigma_px, 0.0, cv::BORDER_REPLICATE);
  } else {
    smooth = gray;
  }
  cv::Mat gradient_u;
  cv::Mat gradient_v;
  cv::spatialGradient(smooth, gradient_u, gradient_v, 3, cv::BORDER_REPLICATE);
  const auto [low, high] = std::minmax(options_.canny_low, options_.canny_high);
  cv::Canny(gradient_u, gradient_v, result.edges, low, high, false);
  result.lines = houghLines(result.edges, options_);
  encodeSectors(gradient_u, gradient_v, result.edges);
  return result;
}

}  // namespace colonnade
