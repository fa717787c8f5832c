// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// Makes the depth a structured-light sensor would give of perfect depth: range limits, the shadow
/// beside near objects (which the projector does not reach), returns lost on surfaces seen at a
/// grazing angle and at jumps, noise, disparity in whole steps, whole millimetres.
class DepthNoise {
 public:
  DepthNoise(const DepthOptions& options, const PinholeCamera& camera, std::uint64_t seed);

  /// depth_m: CV_32FC1 metres along the axis, 0 = nothing there. The same comes back.
  cv::Mat measure(const cv::Mat& depth_m);

 private:
  cv::Mat correlatedNoise();
  /// CV_8UC1: 255 where the projector's light returns.
  cv::Mat lit(const cv::Mat& depth_m);
  double sigma(double depth_m) const;

  DepthOptions options_;
  PinholeCamera camera_;
  Random random_;
  double blur_gain_ = 1.0;  ///< restores the variance after the blur
};

}  // namespace colonnade
