// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "camera_views.hpp"

namespace colonnade {

/// Takes the lens distortion out of images, keeping the pinhole parameters. The maps are computed
/// once per calibration.
class Undistorter {
 public:
  /// Bilinear, for images.
  cv::Mat image(const cv::Mat& pixels, const Calibration& calibration);
  /// Nearest neighbour, so that no depth is invented between two surfaces; 0 outside.
  cv::Mat depth(const cv::Mat& depth, const Calibration& calibration);

 private:
  void prepare(const Calibration& calibration);
  Calibration current_;
  cv::Mat map_a_, map_b_;
};

}  // namespace colonnade
