// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opencv_backend.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "colonnade/base/error.hpp"
#include "sectors.hpp"

namespace colonnade {
namespace {

constexpr int kHalfTurn = 180;      // degrees
constexpr int kDuplicateTheta = 2;  // degrees
constexpr int kDuplicateRho = 3;    // pixels

bool isBetter(const HoughLine& a, const HoughLine& b) {
  return std::tie(a.line_class, b.votes, a.theta_index, a.rho_bin) <
         std::tie(b.line_class, a.votes, b.theta_index, b.rho_bin);
}

/// Close in both parameters; (theta, rho) and (theta - 180 degrees, -rho) are one line.
bool isDuplicate(const HoughLine& a, const HoughLine& b) {
  const int turn = std::abs(a.theta_index - b.theta_index);
  if (turn <= kDuplicateTheta) return std::abs(a.rho_bin - b.rho_bin) <= kDuplicateRho;
  return kHalfTurn - turn <= kDuplicateTheta && std::abs(a.rho_bin + b.rho_bin) <= kDuplicateRho;
}

/// The best lines of each class in order, without near copies of better ones.
std::vector<HoughLine> thinOut(std::vector<HoughLine> lines, int max_of_each_class) {
  std::sort(lines.begin(), lines.end(), isBetter);
  std::vector<HoughLine> kept;
  int kept_of_class[2] = {0, 0};
  for (const auto& line : lines) {
    int& count = kept_of_class[static_cast<int>(line.line_class)];
    if (count >= max_of_each_class) continue;
    if (std::any_of(kept.begin(), kept.end(),
                    [&](const HoughLine& better) { return isDuplicate(better, line); })) {
      continue;
    }
    kept.push_back(line);
    ++count;
  }
  return kept;
}

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
  return thinOut(std::move(lines), options.max_lines);
}

}  // namespace

EdgeLines OpencvBackend::extract(const cv::Mat& gray) {
  EdgeLines result;
  if (gray.empty()) return result;
  if (gray.type() != CV_8UC1) {
    throw Error("edge stage: the image is not 8-bit gray; convert it before extract()");
  }
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
