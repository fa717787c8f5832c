// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace colonnade {

/// Draws in metres (y up) onto a picture that is twice as large and halved at the end, so that all
/// edges are smooth. Lengths ending in _px are pixels of the finished picture.
class Canvas {
 public:
  /// Fits `world` into `width_px`, leaving room above for a title and below for a legend. The
  /// height follows, between a third and the whole of the width.
  Canvas(const Eigen::AlignedBox2d& world, int width_px, int top_px, int bottom_px);

  double pixelsPerMetre() const { return scale_; }
  cv::Size size() const { return size_; }
  Eigen::Vector2d pixelOf(const Eigen::Vector2d& p_world) const;
  const Eigen::AlignedBox2d& visible() const { return visible_; }

  void line(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, double thickness_px,
            const cv::Scalar& colour);
  void path(const std::vector<Eigen::Vector2d>& points_px, double thickness_px,
            const cv::Scalar& colour);
  void dashes(const std::vector<Eigen::Vector2d>& points_px, double thickness_px,
              const cv::Scalar& colour);
  void disc(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& colour);
  void polygon(const std::vector<Eigen::Vector2d>& points_px, const cv::Scalar& colour);
  void rectangle(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px,
                 const cv::Scalar& colour);
  void text(const std::string& text, const Eigen::Vector2d& p_px, double height_px,
            const cv::Scalar& colour, bool bold = false);
  /// Paints the cells of a mask that are not 0; its lower left corner lies at `p_world_corner`.
  void cells(const cv::Mat& mask, const Eigen::Vector2d& p_world_corner, double metres_per_cell,
             const cv::Scalar& colour);

  static double textWidth(const std::string& text, double height_px);
  cv::Mat finished() const;

 private:
  double scale_ = 1.0;
  cv::Size size_;
  Eigen::Vector2d centre_world_;
  Eigen::Vector2d centre_px_;
  Eigen::AlignedBox2d visible_;
  cv::Mat large_;
};

}  // namespace colonnade
