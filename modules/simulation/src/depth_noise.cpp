// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace colonnade {
namespace {

constexpr float kJump = 0.04F;     ///< relative difference of neighbours that makes an edge
constexpr double kJumpLoss = 0.5;  ///< share of edge pixels without a return
constexpr double kReferenceWidthPx = 640.0;

int kernelSize(double sigma_px) { return 2 * static_cast<int>(std::ceil(3.0 * sigma_px)) + 1; }

/// The cosine of the angle between the viewing ray and the surface normal, from the depth of the
/// neighbours; 1 where they do not tell.
double incidenceCosine(const cv::Mat& depth_m, const PinholeCamera& camera, int row, int column) {
  const auto point = [&](int r, int c) -> Eigen::Vector3d {
    return camera.ray(c, r) * static_cast<double>(depth_m.at<float>(r, c));
  };
  const int right = std::min(column + 1, depth_m.cols - 1);
  const int below = std::min(row + 1, depth_m.rows - 1);
  const Eigen::Vector3d p = point(row, column);
  const Eigen::Vector3d across = point(row, right) - point(row, std::max(column - 1, 0));
  const Eigen::Vector3d down = point(below, column) - point(std::max(row - 1, 0), column);
  const Eigen::Vector3d normal = across.cross(down);
  const double length = normal.norm() * p.norm();
  return length > 0.0 ? std::abs(normal.dot(p)) / length : 1.0;
}

bool atJump(const cv::Mat& depth_m, int row, int column) {
  const float z = depth_m.at<float>(row, column);
  for (const auto& [r, c] :
       {std::pair{row, column - 1}, {row, column + 1}, {row - 1, column}, {row + 1, column}}) {
    if (r < 0 || c < 0 || r >= depth_m.rows || c >= depth_m.cols) continue;
    // Inverse depth is straight along a plane, so that a slanted plane is no jump.
    if (std::abs(depth_m.at<float>(r, c) - z) > kJump * z) {
      const int r2 = 2 * row - r, c2 = 2 * column - c;
      if (r2 < 0 || c2 < 0 || r2 >= depth_m.rows || c2 >= depth_m.cols) return true;
      const float a = depth_m.at<float>(r, c), b = depth_m.at<float>(r2, c2);
      if (a <= 0.0F || b <= 0.0F) return true;
      if (std::abs(1.0F / a + 1.0F / b - 2.0F / z) * z > kJump) return true;
    }
  }
  return false;
}

}  // namespace

DepthNoise::DepthNoise(const DepthOptions& options, const PinholeCamera& camera, std::uint64_t seed)
    : options_(options), camera_(camera), random_(seed, "depth") {
  const double s = options_.noise_correlation_px;
  if (s <= 0.0) return;
  const cv::Mat kernel = cv::getGaussianKernel(kernelSize(s), s, CV_64F);
  blur_gain_ = 1.0 / kernel.dot(kernel);  // two dimensions: the sum of squares, squared, rooted
}

double DepthNoise::sigma(double depth_m) const {
  const double beyond = depth_m - 0.4;
  return options_.noise_floor_m + options_.noise_growth_per_m * beyond * beyond;
}

cv::Mat DepthNoise::correlatedNoise() {
  cv::Mat noise(camera_.height_px, camera_.width_px, CV_32FC1);
  for (auto value = noise.begin<float>(); value != noise.end<float>(); ++value) {
    *value = static_cast<float>(random_.normal());
  }
  const double s = options_.noise_correlation_px;
  if (s <= 0.0) return noise;
  const int size = kernelSize(s);
  cv::GaussianBlur(noise, noise, cv::Size(size, size), s, s, cv::BORDER_REFLECT);
  return noise * blur_gain_;
}

cv::Mat DepthNoise::lit(const cv::Mat& depth_m) {
  cv::Mat mask(depth_m.size(), CV_8UC1, cv::Scalar(255));
  if (options_.baseline_m <= 0.0) return mask;
  const double shift = camera_.fx_px * options_.baseline_m;
  for (int row = 0; row < depth_m.rows; ++row) {
    // From the right: a column of the projector that a surface has taken is dark farther away.
    double taken = std::numeric_limits<double>::infinity();
    for (int column = depth_m.cols - 1; column >= 0; --column) {
      const double z = depth_m.at<float>(row, column);
      if (z <= 0.0) continue;
      const double projector_column = column - shift / z;
      if (projector_column > taken + 0.5) {
        mask.at<unsigned char>(row, column) = 0;
      } else {
        taken = std::min(taken, projector_column);
      }
    }
  }
  return mask;
}

cv::Mat DepthNoise::measure(const cv::Mat& depth_m) {
  const auto& o = options_;
  const cv::Mat noise = correlatedNoise();
  const cv::Mat light = lit(depth_m);
  const double cos_start = std::cos(o.grazing_start);
  const double cos_end = std::min(std::cos(o.grazing_end), cos_start);
  // Rounding is that of the 640 pixel wide sensor, whatever the width of the images.
  const double disparity_gain = camera_.fx_px * kReferenceWidthPx / camera_.width_px *
                                o.baseline_m * o.disparity_steps_per_px;
  cv::Mat measured = cv::Mat::zeros(depth_m.size(), CV_32FC1);
  for (int row = 0; row < depth_m.rows; ++row) {
    for (int column = 0; column < depth_m.cols; ++column) {
      const double luck = random_.uniform();
      const double z = depth_m.at<float>(row, column);
      if (z < o.range_min_m || z > o.range_max_m || light.at<unsigned char>(row, column) == 0)
        continue;
      if (luck < o.loss_fraction) continue;
      const double cosine = incidenceCosine(depth_m, camera_, row, column);
      if (cosine <= cos_end) continue;
      if (cosine < cos_start && luck > (cosine - cos_end) / (cos_start - cos_end)) continue;
      if (luck < kJumpLoss && atJump(depth_m, row, column)) continue;

      const double rounding = disparity_gain > 0.0 ? z * z / disparity_gain : 0.0;
      const double total = sigma(z);
      // The rounding has a share of the noise: variance of a uniform distribution, step^2 / 12.
      const double rest = std::sqrt(std::max(0.0, total * total - rounding * rounding / 12.0));
      double result = z + rest * static_cast<double>(noise.at<float>(row, column));
      if (disparity_gain > 0.0 && result > 0.0) {
        result = disparity_gain / std::max(1.0, std::round(disparity_gain / result));
      }
      result = 0.001 * std::round(1000.0 * result);
      if (result < o.range_min_m || result > o.range_max_m) continue;
      measured.at<float>(row, column) = static_cast<float>(result);
    }
  }
  return measured;
}

}  // namespace colonnade
