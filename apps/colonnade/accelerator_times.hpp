// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/accelerator/model_transport.hpp"

namespace colonnade {

/// Of processor time of this process, which other programs disturb less than the clock on the wall.
double processorMilliseconds(const std::function<void()>& work);

/// What `fixed` is measured against: OpenCV's own Canny and Hough, with the parameters of the
/// `opencv` backend.
class BareOpenCv {
 public:
  /// Gaussian and Canny.
  void canny(const cv::Mat& gray);
  /// HoughLines over 180 angles on the edges of the last canny().
  void hough();

 private:
  cv::Mat smooth_;
  cv::Mat edges_;
  std::vector<cv::Vec2f> lines_;
};

/// Processor time of one thread, medians.
struct SoftwareTimes {
  cv::Size size;
  double opencv_canny_ms = 0.0;  ///< Gaussian and Canny as the `opencv` backend calls them
  double opencv_hough_ms = 0.0;  ///< HoughLines over 180 angles
  double opencv_ms = 0.0;        ///< the whole `opencv` backend
  double fixed_ms = 0.0;         ///< the whole `fixed` backend
};

/// Clocks of the Verilated model.
struct HardwareTimes {
  AcceleratorModel model;
  std::size_t lines = 0;
  std::uint32_t canny_clocks = 0;      ///< first pixel in to last edge out
  std::uint32_t clocks = 0;            ///< first pixel in to last line out
  std::uint32_t tail_clocks = 0;       ///< last pixel in to last line out
  std::size_t waiting_lines = 0;       ///< that leave a clock later, as others fire in their step
  std::uint32_t sustained_clocks = 0;  ///< from frame to frame, when they follow without a gap
};

/// A corridor with pillars and noise, always the same: what is timed when no picture is given.
cv::Mat drawnCorridor();

SoftwareTimes softwareTimes(const cv::Mat& gray);
/// gray: of the model's size. Throws Error (kFailed) when the model's answer is not that of
/// `fixed`.
HardwareTimes hardwareTimes(const AcceleratorModel& model, const cv::Mat& gray);

}  // namespace colonnade
