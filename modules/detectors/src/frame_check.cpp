// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/frame_check.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

namespace colonnade {
namespace {

constexpr int kLeastSide_px = 16;
constexpr int kStep_px = 8;  ///< every so many pixels are looked at
constexpr int kLeastContrast = 4;
constexpr double kMostEdges = 0.16;  ///< of the pixels; pictures of rooms have 3 to 8 %
constexpr double kLeastDepth = 0.005;

/// Are the darkest and the brightest pixel looked at so many gray levels apart? Looks no farther
/// than it must.
bool hasContrast(const cv::Mat& gray) {
  int low = 255;
  int high = 0;
  for (int v = 0; v < gray.rows; v += kStep_px) {
    const auto* row = gray.ptr<unsigned char>(v);
    for (int u = 0; u < gray.cols; u += kStep_px) {
      low = std::min<int>(low, row[u]);
      high = std::max<int>(high, row[u]);
    }
    if (high - low >= kLeastContrast) return true;
  }
  return false;
}

double shareOfEdges(const cv::Mat& edges) {
  long count = 0;
  long all = 0;
  for (int v = 0; v < edges.rows; v += kStep_px) {
    count += cv::countNonZero(edges.row(v));
    all += edges.cols;
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

/// Looks no farther than it must.
bool holdsDepth(const cv::Mat& depth_m) {
  const auto looked_at = [](int pixels) { return (pixels + kStep_px - 1) / kStep_px; };
  const double all = static_cast<double>(looked_at(depth_m.rows)) * looked_at(depth_m.cols);
  long valid = 0;
  for (int v = 0; v < depth_m.rows; v += kStep_px) {
    const auto* row = depth_m.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; u += kStep_px)
      valid += row[u] > 0.2F && row[u] < 15.0F;  // not NaN
    if (static_cast<double>(valid) / all >= kLeastDepth) return true;
  }
  return false;
}

std::string lackOfImage(const Frame& frame, const EdgeLines& edges) {
  const cv::Mat& gray = frame.gray;
  if (gray.type() != CV_8UC1) return "the image is not 8-bit gray";
  if (std::min(gray.cols, gray.rows) < kLeastSide_px) return "the image is too small";
  if (!hasContrast(gray)) return "the image has no contrast";
  if (edges.edges.size() == gray.size() && shareOfEdges(edges.edges) > kMostEdges)
    return "the image is noise";
  return {};
}

std::string lackOfDepth(const Frame& frame) {
  const cv::Mat& depth_m = frame.depth_m;
  if (depth_m.type() != CV_32FC1) return "the depth is not in metres";
  if (!frame.gray.empty() && depth_m.size() != frame.gray.size())
    return "the depth has another size than the image";
  if (std::min(depth_m.cols, depth_m.rows) < kLeastSide_px) return "the depth is too small";
  if (!holdsDepth(depth_m)) return "the depth holds no values";
  return {};
}

}  // namespace

FrameCheck checkFrame(const Frame& frame, const EdgeLines& edges) {
  FrameCheck check;
  const auto add = [&](std::string reason) {
    const bool usable = reason.empty();
    if (!usable) check.lacking.push_back(std::move(reason));
    return usable;
  };
  if (!frame.camera.isCalibrated()) add("the camera is not calibrated");
  check.image_usable = !frame.gray.empty() && add(lackOfImage(frame, edges));
  check.depth_usable = !frame.depth_m.empty() && add(lackOfDepth(frame));
  if (frame.gray.empty() && frame.depth_m.empty()) add("neither image nor depth");
  return check;
}

}  // namespace colonnade
