// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/colour_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace colonnade {
namespace {

/// The share of a quantity with this time constant that is left after the interval.
double kept(double interval_s, double constant_s) {
  return constant_s > 0.0 ? std::exp(-interval_s / constant_s) : 0.0;
}

/// Sigma of the noise at each gray level.
std::array<float, 256> noiseTable(const ColourOptions& o, double gain) {
  std::array<float, 256> table{};
  for (std::size_t level = 0; level < table.size(); ++level) {
    table[level] = static_cast<float>(
        std::sqrt(o.read_noise * o.read_noise * gain * gain +
                  o.shot_noise * o.shot_noise * gain * static_cast<double>(level)));
  }
  return table;
}

}  // namespace

void ColourNoise::expose(const cv::Mat& colour, const Eigen::Vector3d& light, double interval_s) {
  const auto& o = options_;
  if (o.auto_exposure) {
    // The camera reacts to the pictures it has taken; at the first one it has settled already.
    const auto mean = cv::mean(colour);  // blue, green, red
    const double gray =
        0.114 * mean[0] * light.z() + 0.587 * mean[1] * light.y() + 0.299 * mean[2] * light.x();
    const double asked = std::clamp(o.exposure_target / std::max(gray, 0.01),
                                    1.0 / o.exposure_gain_limit, o.exposure_gain_limit);
    if (first_) auto_gain_ = wanted_gain_ = asked;
    auto_gain_ += (1.0 - kept(interval_s, o.exposure_lag_s)) * (wanted_gain_ - auto_gain_);
    wanted_gain_ = asked;
  }
  const double memory = first_ ? 0.0 : kept(interval_s, o.exposure_noise_s);
  wander_ =
      memory * wander_ + std::sqrt(1.0 - memory * memory) * o.exposure_noise * random_.normal();
  gain_ = auto_gain_ * std::max(0.0, 1.0 + wander_);
  first_ = false;
}

void ColourNoise::shade(const cv::Size& size) {
  if (shading_.size() == size) return;
  shading_.create(size, CV_32FC1);
  const double centre_u = 0.5 * (size.width - 1), centre_v = 0.5 * (size.height - 1);
  const double corner = centre_u * centre_u + centre_v * centre_v;
  for (int row = 0; row < size.height; ++row) {
    auto* shading = shading_.ptr<float>(row);
    for (int column = 0; column < size.width; ++column) {
      const double du = column - centre_u, dv = row - centre_v;
      shading[column] =
          static_cast<float>(1.0 - options_.vignetting * (du * du + dv * dv) / corner);
    }
  }
}

cv::Mat ColourNoise::measure(const cv::Mat& colour, const Eigen::Vector3d& light,
                             double interval_s) {
  const auto& o = options_;
  shade(colour.size());
  expose(colour, light, interval_s);
  cv::Mat blurred = colour;
  if (o.blur_px > 0.0) {
    cv::GaussianBlur(colour, blurred, cv::Size(0, 0), o.blur_px, o.blur_px, cv::BORDER_REPLICATE);
  }
  const auto sigmas = noiseTable(o, gain_);
  const std::array<float, 3> factors = {static_cast<float>(gain_ * light.z()),  // blue first
                                        static_cast<float>(gain_ * light.y()),
                                        static_cast<float>(gain_ * light.x())};
  const auto shared = static_cast<float>(std::sqrt(1.0 - o.chroma_noise * o.chroma_noise));
  const auto apart = static_cast<float>(o.chroma_noise);
  std::vector<float> noise(4 * static_cast<std::size_t>(colour.cols));
  cv::Mat measured(colour.size(), CV_8UC3);
  for (int row = 0; row < colour.rows; ++row) {
    random_.normals(noise.data(), noise.size());
    const auto* before = blurred.ptr<unsigned char>(row);
    auto* after = measured.ptr<unsigned char>(row);
    const auto* shading = shading_.ptr<float>(row);
    const float* n = noise.data();
    for (int column = 0; column < colour.cols; ++column, before += 3, after += 3, n += 4) {
      for (int channel = 0; channel < 3; ++channel) {
        const float level = factors[static_cast<std::size_t>(channel)] * shading[column] *
                            static_cast<float>(before[channel]);
        const float sigma = sigmas[static_cast<std::size_t>(std::min(level, 255.0F))];
        const float value = level + sigma * (shared * n[3] + apart * n[channel]);
        after[channel] = static_cast<unsigned char>(std::clamp(value + 0.5F, 0.0F, 255.0F));
      }
    }
  }
  return measured;
}

}  // namespace colonnade
