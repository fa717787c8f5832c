// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/colour_noise.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace colonnade {

cv::Mat ColourNoise::measure(const cv::Mat& colour) {
  const auto& o = options_;
  cv::Mat blurred = colour;
  if (o.blur_px > 0.0) {
    cv::GaussianBlur(colour, blurred, cv::Size(0, 0), o.blur_px, o.blur_px, cv::BORDER_REPLICATE);
  }
  const double gain = 1.0 + o.exposure_noise * random_.normal();
  const double centre_u = 0.5 * (colour.cols - 1), centre_v = 0.5 * (colour.rows - 1);
  const double corner = centre_u * centre_u + centre_v * centre_v;
  const double shared = std::sqrt(1.0 - o.chroma_noise * o.chroma_noise);
  cv::Mat measured(colour.size(), CV_8UC3);
  for (int row = 0; row < colour.rows; ++row) {
    for (int column = 0; column < colour.cols; ++column) {
      const double du = column - centre_u, dv = row - centre_v;
      const double light = gain * (1.0 - o.vignetting * (du * du + dv * dv) / corner);
      const double common = random_.normal();
      const auto& before = blurred.at<cv::Vec3b>(row, column);
      auto& after = measured.at<cv::Vec3b>(row, column);
      for (int channel = 0; channel < 3; ++channel) {
        const double level = light * before[channel];
        const double sigma = std::sqrt(o.read_noise * o.read_noise +
                                       o.shot_noise * o.shot_noise * std::max(0.0, level));
        const double noise = shared * common + o.chroma_noise * random_.normal();
        after[channel] = cv::saturate_cast<unsigned char>(level + sigma * noise);
      }
    }
  }
  return measured;
}

}  // namespace colonnade
