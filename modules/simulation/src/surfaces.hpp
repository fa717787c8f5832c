// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// What perfect depth tells about the surfaces seen. Inverse depth is the quantity to
/// differentiate: in the image of a plane it is affine in (u, v), whatever the slant.
struct Surfaces {
  cv::Mat depth_m;  ///< CV_32FC1, as given
  cv::Mat inverse;  ///< CV_32FC1, 1/m, 0 = nothing there
  /// CV_32FC2: change of `inverse` per pixel to the right and downwards on the surface of the
  /// pixel, that is the smaller of the differences to either side.
  cv::Mat slope;
  cv::Mat jump;  ///< CV_8UC1, 255 where the surface ends: inverse depth is far from affine

  /// perfect_depth_m: CV_32FC1, 0 = nothing there.
  explicit Surfaces(const cv::Mat& perfect_depth_m);

  /// Inverse depth at (u, v) of the surface seen at pixel (row, column), a neighbour.
  double inverseAt(int row, int column, double u, double v) const {
    const auto& d = slope.at<cv::Vec2f>(row, column);
    return static_cast<double>(inverse.at<float>(row, column)) +
           static_cast<double>(d[0]) * (u - column) + static_cast<double>(d[1]) * (v - row);
  }
};

}  // namespace colonnade
