// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lens.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace colonnade {

void Undistorter::prepare(const Calibration& calibration) {
  if (!map_a_.empty() && calibration == current_) return;
  current_ = calibration;
  const auto& c = calibration.pinhole;
  const cv::Matx33d K(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  const cv::Size size(c.width_px, c.height_px);
  const auto& k = calibration.distortion;
  if (calibration.lens == LensModel::kFisheye) {
    const cv::Vec4d d(k[0], k[1], k[2], k[3]);
    cv::fisheye::initUndistortRectifyMap(K, d, cv::Matx33d::eye(), K, size, CV_16SC2, map_a_,
                                         map_b_);
  } else {
    const cv::Vec<double, 8> d(k.data());
    cv::initUndistortRectifyMap(K, d, cv::Matx33d::eye(), K, size, CV_16SC2, map_a_, map_b_);
  }
}

cv::Mat Undistorter::image(const cv::Mat& pixels, const Calibration& calibration) {
  if (calibration.lens == LensModel::kNone) return pixels;
  prepare(calibration);
  cv::Mat result;
  cv::remap(pixels, result, map_a_, map_b_, cv::INTER_LINEAR);
  return result;
}

cv::Mat Undistorter::depth(const cv::Mat& depth, const Calibration& calibration) {
  if (calibration.lens == LensModel::kNone) return depth;
  prepare(calibration);
  cv::Mat result;
  cv::remap(depth, result, map_a_, map_b_, cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(0));
  return result;
}

}  // namespace colonnade
