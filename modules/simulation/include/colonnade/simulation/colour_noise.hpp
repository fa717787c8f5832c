// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// Makes the picture of a plain camera of a perfect one: lens blur, vignetting, wandering exposure,
/// shot and read noise.
class ColourNoise {
 public:
  ColourNoise(const ColourOptions& options, std::uint64_t seed)
      : options_(options), random_(seed, "colour") {}

  /// CV_8UC3 in and out.
  cv::Mat measure(const cv::Mat& colour);

 private:
  ColourOptions options_;
  Random random_;
};

}  // namespace colonnade
