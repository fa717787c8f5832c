// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/draw_detections.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

const cv::Scalar kRanged(80, 230, 60);
const cv::Scalar kBearingOnly(230, 200, 40);
const cv::Scalar kFloor(0, 190, 255);
const cv::Scalar kJoint(0, 110, 150);
const cv::Scalar kCorner(230, 80, 230);
const cv::Scalar kRefused(60, 60, 220);
const cv::Scalar kText(235, 235, 235);
constexpr int kLegendHeight = 40;

cv::Point pixel(const Eigen::Vector2d& p) {
  constexpr double kFar = 10000.0;
  return {static_cast<int>(std::clamp(p.x(), -kFar, kFar)),
          static_cast<int>(std::clamp(p.y(), -kFar, kFar))};
}

cv::Scalar colourOf(const Detection& detection) {
  if (!detection.accepted()) return kRefused;
  switch (detection.kind()) {
    case LandmarkKind::kPillarEdge:
      return detection.measurement.hasRange() ? kRanged : kBearingOnly;
    case LandmarkKind::kFloorEdge:
      return detection.on_surface ? kJoint : kFloor;
    case LandmarkKind::kDepthSlope:
      return kCorner;
  }
  return kText;
}

std::string labelOf(const Detection& detection) {
  if (!detection.accepted()) return detection.refusal;
  const auto& m = detection.measurement;
  std::string label = formatFixed(degrees(m.z[0]), 1);
  if (m.hasRange()) label += " " + formatFixed(m.z[1], 2) + "m";
  if (detection.kind() == LandmarkKind::kFloorEdge && detection.on_surface) label += " joint";
  return label;
}

void write(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& colour) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.32, cv::Scalar(0, 0, 0), 2,
              cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.32, colour, 1, cv::LINE_AA);
}

cv::Mat background(const Frame& frame) {
  cv::Mat picture;
  if (frame.colour.type() == CV_8UC3 && !frame.colour.empty()) {
    picture = frame.colour.clone();
  } else if (frame.gray.type() == CV_8UC1 && !frame.gray.empty()) {
    cv::cvtColor(frame.gray, picture, cv::COLOR_GRAY2BGR);
  } else if (!frame.depth_m.empty()) {
    cv::Mat scaled;
    frame.depth_m.convertTo(scaled, CV_8U, 40.0);
    cv::cvtColor(scaled, picture, cv::COLOR_GRAY2BGR);
  } else {
    picture = cv::Mat::zeros(240, 320, CV_8UC3);
  }
  return picture;
}

/// Moving things reddish, panes and mirrors bluish.
void tint(cv::Mat& view, const Segmentation& segmentation) {
  const int side = segmentation.cell_px;
  for (int row = 0; row < segmentation.rows; ++row) {
    for (int column = 0; column < segmentation.columns; ++column) {
      const auto label =
          segmentation.labels[static_cast<std::size_t>(row * segmentation.columns + column)];
      if (label == Segmentation::kStatic) continue;
      const cv::Rect cell =
          cv::Rect(column * side, row * side, side, side) & cv::Rect(0, 0, view.cols, view.rows);
      cv::Mat part = view(cell);
      part += label == Segmentation::kMoving ? cv::Scalar(0, 0, 70) : cv::Scalar(70, 20, 0);
    }
  }
}

void drawLegend(cv::Mat& picture, const Detections& detections) {
  std::array<int, 5> counts{};
  for (const auto& detection : detections) {
    std::size_t entry = 4;
    if (detection.accepted()) {
      entry = 1 + static_cast<std::size_t>(detection.kind());
      if (entry == 1 && detection.measurement.hasRange()) entry = 0;
    }
    ++counts[entry];
  }
  const std::array<std::pair<const char*, cv::Scalar>, 5> entries{{{"pillar edge", kRanged},
                                                                   {"bearing only", kBearingOnly},
                                                                   {"floor edge", kFloor},
                                                                   {"corner", kCorner},
                                                                   {"refused", kRefused}}};
  const int top = picture.rows - kLegendHeight;
  const int width = picture.cols / static_cast<int>(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const int left = static_cast<int>(i) * width + 6;
    cv::line(picture, {left, top + 14}, {left + 24, top + 14}, entries[i].second, 2);
    write(picture, entries[i].first + (": " + std::to_string(counts[i])), {left, top + 32}, kText);
  }
}

}  // namespace

cv::Mat drawDetections(const Frame& frame, const EdgeLines& edges, const Detections& detections,
                       const Segmentation* segmentation) {
  const cv::Mat image = background(frame);
  cv::Mat picture = cv::Mat::zeros(image.rows + kLegendHeight, image.cols, CV_8UC3);
  cv::Mat view = picture.rowRange(0, image.rows);
  image.convertTo(view, -1, 0.7);
  if (edges.edges.size() == image.size()) view.setTo(cv::Scalar(110, 110, 110), edges.edges != 0);
  if (segmentation) tint(view, *segmentation);
  for (const bool accepted : {false, true}) {
    for (const auto& detection : detections) {
      if (detection.accepted() != accepted) continue;
      const cv::Scalar colour = colourOf(detection);
      const cv::Point a = pixel(detection.a_px);
      const cv::Point b = pixel(detection.b_px);
      cv::line(view, a, b, colour, accepted ? 2 : 1, cv::LINE_AA);
      if (accepted && detection.partner && *detection.partner < detections.size()) {
        const auto& other = detections[*detection.partner];
        cv::line(view, pixel((detection.a_px + detection.b_px) / 2.0),
                 pixel((other.a_px + other.b_px) / 2.0), colour, 1, cv::LINE_AA);
      }
      const double share = detection.kind() == LandmarkKind::kDepthSlope ? 0.85
                           : accepted                                    ? 0.5
                                                                         : 0.35;
      write(view, labelOf(detection),
            pixel(detection.a_px + share * (detection.b_px - detection.a_px)), colour);
    }
  }
  drawLegend(picture, detections);
  return picture;
}

}  // namespace colonnade
