// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace colonnade {
namespace {

constexpr int kZoom = 2;
constexpr int kSubPixelBits = 4;
constexpr double kSideMargin_px = 24.0;
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kFontHeight_px = 22.0;  ///< capital letters of this font at scale 1

/// Coordinates far outside would overflow OpenCV's integers.
double tame(double px) { return std::clamp(px, -20000.0, 20000.0); }

cv::Point fine(const Eigen::Vector2d& p_px) {
  constexpr double kFactor = kZoom * (1 << kSubPixelBits);
  return {static_cast<int>(std::lround(tame(p_px.x()) * kFactor)),
          static_cast<int>(std::lround(tame(p_px.y()) * kFactor))};
}

int zoomed(double px) { return std::max(1, static_cast<int>(std::lround(px * kZoom))); }

std::vector<cv::Point> fine(const std::vector<Eigen::Vector2d>& points_px) {
  std::vector<cv::Point> points;
  for (const auto& p_px : points_px) points.push_back(fine(p_px));
  return points;
}

}  // namespace

Canvas::Canvas(const Eigen::AlignedBox2d& world, int width_px, int top_px, int bottom_px) {
  const double inner_width = width_px - 2.0 * kSideMargin_px;
  const Eigen::Vector2d extent = world.sizes().cwiseMax(0.5);
  scale_ = std::min(inner_width / extent.x(), width_px / extent.y());
  const double inner_height = std::max(scale_ * extent.y(), width_px / 3.0);
  size_ = {width_px, top_px + bottom_px + static_cast<int>(std::ceil(inner_height))};
  centre_world_ = world.center();
  centre_px_ = {width_px / 2.0, top_px + inner_height / 2.0};
  const Eigen::Vector2d half = Eigen::Vector2d(width_px / 2.0, inner_height / 2.0) / scale_;
  visible_ = {centre_world_ - half, centre_world_ + half};
  large_.create(size_.height * kZoom, size_.width * kZoom, CV_8UC3);
  large_ = cv::Scalar::all(255);
}

Eigen::Vector2d Canvas::pixelOf(const Eigen::Vector2d& p_world) const {
  const Eigen::Vector2d offset = scale_ * (p_world - centre_world_);
  return {centre_px_.x() + offset.x(), centre_px_.y() - offset.y()};
}

void Canvas::line(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, double thickness_px,
                  const cv::Scalar& colour) {
  cv::line(large_, fine(a_px), fine(b_px), colour, zoomed(thickness_px), cv::LINE_AA,
           kSubPixelBits);
}

void Canvas::path(const std::vector<Eigen::Vector2d>& points_px, double thickness_px,
                  const cv::Scalar& colour) {
  if (points_px.size() < 2) return;
  const std::vector<std::vector<cv::Point>> lines = {fine(points_px)};
  cv::polylines(large_, lines, false, colour, zoomed(thickness_px), cv::LINE_AA, kSubPixelBits);
}

void Canvas::dashes(const std::vector<Eigen::Vector2d>& points_px, double thickness_px,
                    const cv::Scalar& colour) {
  constexpr double kDash_px = 9.0;
  constexpr double kPeriod_px = 15.0;
  double along_px = 0.0;
  for (std::size_t i = 1; i < points_px.size(); ++i) {
    const Eigen::Vector2d& a_px = points_px[i - 1];
    const Eigen::Vector2d step_px = points_px[i] - a_px;
    const double length_px = step_px.norm();
    if (length_px == 0.0) continue;
    const auto first = static_cast<long>(std::floor(along_px / kPeriod_px));
    const auto last = static_cast<long>(std::floor((along_px + length_px) / kPeriod_px));
    for (long k = first; k <= last; ++k) {
      const double begin = std::max(static_cast<double>(k) * kPeriod_px - along_px, 0.0);
      const double end =
          std::min(static_cast<double>(k) * kPeriod_px + kDash_px - along_px, length_px);
      if (begin < end)
        line(a_px + step_px * (begin / length_px), a_px + step_px * (end / length_px), thickness_px,
             colour);
    }
    along_px += length_px;
  }
}

void Canvas::disc(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& colour) {
  const int radius = zoomed(radius_px * (1 << kSubPixelBits));
  cv::circle(large_, fine(p_px), radius, colour, cv::FILLED, cv::LINE_AA, kSubPixelBits);
}

void Canvas::polygon(const std::vector<Eigen::Vector2d>& points_px, const cv::Scalar& colour) {
  cv::fillConvexPoly(large_, fine(points_px), colour, cv::LINE_AA, kSubPixelBits);
}

void Canvas::rectangle(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px,
                       const cv::Scalar& colour) {
  cv::rectangle(large_, fine(a_px), fine(b_px), colour, cv::FILLED, cv::LINE_AA, kSubPixelBits);
}

void Canvas::text(const std::string& text, const Eigen::Vector2d& p_px, double height_px,
                  const cv::Scalar& colour, bool bold) {
  const cv::Point start(static_cast<int>(std::lround(tame(p_px.x()) * kZoom)),
                        static_cast<int>(std::lround(tame(p_px.y()) * kZoom)));
  cv::putText(large_, text, start, kFont, kZoom * height_px / kFontHeight_px, colour, bold ? 2 : 1,
              cv::LINE_AA);
}

double Canvas::textWidth(const std::string& text, double height_px) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, kZoom * height_px / kFontHeight_px, 1, &baseline).width /
         static_cast<double>(kZoom);
}

void Canvas::cells(const cv::Mat& mask, const Eigen::Vector2d& p_world_corner,
                   double metres_per_cell, const cv::Scalar& colour) {
  const Eigen::Vector2d top_left =
      pixelOf(p_world_corner + Eigen::Vector2d(0.0, mask.rows * metres_per_cell));
  const double zoom = kZoom * scale_ * metres_per_cell;
  // Cell (0, 0) covers the pixels from top_left on; OpenCV places pixel centres on whole numbers.
  const cv::Matx23d M(zoom, 0.0, kZoom * top_left.x() + 0.5 * zoom - 0.5, 0.0, zoom,
                      kZoom * top_left.y() + 0.5 * zoom - 0.5);
  cv::Mat large_mask;
  cv::warpAffine(mask, large_mask, M, large_.size(), cv::INTER_NEAREST, cv::BORDER_CONSTANT,
                 cv::Scalar::all(0));
  large_.setTo(colour, large_mask);
}

cv::Mat Canvas::finished() const {
  cv::Mat result;
  cv::resize(large_, result, size_, 0.0, 0.0, cv::INTER_AREA);
  return result;
}

}  // namespace colonnade
