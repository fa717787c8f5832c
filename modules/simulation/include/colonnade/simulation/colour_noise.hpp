// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>

#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// Makes the picture of a plain camera of a perfect one: lens blur, vignetting, exposure, shot and
/// read noise (see ColourOptions).
class ColourNoise {
 public:
  /// Cameras with streams of different names have noise of their own.
  ColourNoise(const ColourOptions& options, std::uint64_t seed, std::string_view stream = "colour")
      : options_(options), random_(seed, stream) {}

  /// CV_8UC3 in and out. `light`: of red, green, blue, relative to the picture; `interval_s`: since
  /// the picture before.
  cv::Mat measure(const cv::Mat& colour, const Eigen::Vector3d& light = Eigen::Vector3d::Ones(),
                  double interval_s = 0.1);

  /// Gray levels per level of light of the last picture, in its middle.
  double gain() const { return gain_; }

 private:
  void expose(const cv::Mat& colour, const Eigen::Vector3d& light, double interval_s);
  void shade(const cv::Size& size);

  ColourOptions options_;
  Random random_;
  cv::Mat shading_;  ///< CV_32FC1, what the lens lets through
  bool first_ = true;
  double auto_gain_ = 1.0;    ///< what auto-exposure has settled on
  double wanted_gain_ = 1.0;  ///< what the last picture asked for
  double wander_ = 0.0;
  double gain_ = 1.0;
};

}  // namespace colonnade
