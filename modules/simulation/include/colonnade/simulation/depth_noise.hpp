// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

struct Surfaces;

/// Makes the depth a structured-light sensor would give of perfect depth: range limits, the shadow
/// beside near objects (which the projector does not reach), returns lost on glass, on surfaces
/// seen at a grazing angle and at jumps, frayed outlines, noise, disparity in whole steps, whole
/// millimetres. Figures and sources: DepthOptions.
class DepthNoise {
 public:
  DepthNoise(const DepthOptions& options, const PinholeCamera& camera, std::uint64_t seed);

  /// depth_m: CV_32FC1 metres along the axis, 0 = nothing there. `no_return`: CV_8UC1, not 0 on
  /// glass and mirrors; may be empty. Returns CV_16UC1 millimetres, 0 = no depth.
  cv::Mat measure(const cv::Mat& depth_m, const cv::Mat& no_return = {});
  cv::Mat measure(const Surfaces& surfaces, const cv::Mat& no_return);

 private:
  /// CV_32FC1 standard normal noise, correlated over `blur_px`.
  cv::Mat noiseField(double blur_px);
  /// CV_8UC1: 255 where the projector's light returns.
  cv::Mat lit(const Surfaces& surfaces, const cv::Mat& no_return) const;
  /// CV_16SC2: for every pixel the column and row it gets its depth from, relative.
  cv::Mat fraying(const Surfaces& surfaces);
  double cosineOfIncidence(const Surfaces& surfaces, int row, int column) const;
  double sigma(double depth_m, double cosine) const;

  DepthOptions options_;
  PinholeCamera camera_;
  Random random_;
};

}  // namespace colonnade
