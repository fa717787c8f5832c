// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "surfaces.hpp"

namespace colonnade {
namespace {

/// Pixels of noise and disparity are those of the sensor, whatever the width of the images.
constexpr double kSensorWidthPx = 640.0;
constexpr double kFrayLengthPx = 1.5;  ///< along an outline; a sensor correlates small windows
constexpr double kSteepest = radians(85.0);  ///< the published angles end about here
constexpr double kMillimetre = 0.001;

int kernelSize(double sigma_px) { return 2 * static_cast<int>(std::ceil(3.0 * sigma_px)) + 1; }

/// To the next whole number, of what is positive and not huge; a call of the library costs more.
double rounded(double value) { return static_cast<double>(static_cast<std::int64_t>(value + 0.5)); }

/// theta / (pi/2 - theta) of the noise models, from the cosine of theta.
double steepness(double cosine) {
  const double theta = std::min(std::acos(std::clamp(cosine, 0.0, 1.0)), kSteepest);
  return theta / (0.5 * kPi - theta);
}

}  // namespace

DepthNoise::DepthNoise(const DepthOptions& options, const PinholeCamera& camera, std::uint64_t seed)
    : options_(options), camera_(camera), random_(seed, "depth") {}

double DepthNoise::sigma(double depth_m, double cosine) const {
  const double beyond = depth_m - 0.4;
  const double axial = options_.noise_floor_m + options_.noise_growth_per_m * beyond * beyond;
  if (options_.noise_grazing_m <= 0.0) return axial;
  const double slant = steepness(cosine);
  return axial + options_.noise_grazing_m / std::sqrt(depth_m) * slant * slant;
}

cv::Mat DepthNoise::noiseField(double blur_px) {
  cv::Mat noise(camera_.height_px, camera_.width_px, CV_32FC1);
  random_.normals(noise.ptr<float>(), noise.total());
  if (blur_px <= 0.0) return noise;
  const int size = kernelSize(blur_px);
  cv::GaussianBlur(noise, noise, cv::Size(size, size), blur_px, blur_px, cv::BORDER_REFLECT);
  const cv::Mat kernel = cv::getGaussianKernel(size, blur_px, CV_64F);
  noise *= 1.0 / kernel.dot(kernel);  // two dimensions: the sum of squares, squared, rooted
  return noise;
}

/// With n the normal and d the distance of the plane, 1/z = n . ray / d: the slopes of inverse
/// depth are n_x / (d f_x) and n_y / (d f_y).
double DepthNoise::cosineOfIncidence(const Surfaces& surfaces, int row, int column) const {
  const auto& slope = surfaces.slope.at<cv::Vec2f>(row, column);
  const double inverse = surfaces.inverse.at<float>(row, column);
  const double right = slope[0] * camera_.fx_px, down = slope[1] * camera_.fy_px;
  const double x = (column - camera_.cx_px) / camera_.fx_px;
  const double y = (row - camera_.cy_px) / camera_.fy_px;
  const double forward = inverse - right * x - down * y;
  const double lengths = (right * right + down * down + forward * forward) * (x * x + y * y + 1.0);
  return lengths > 0.0 ? inverse / std::sqrt(lengths) : 1.0;
}

cv::Mat DepthNoise::lit(const Surfaces& surfaces, const cv::Mat& no_return) const {
  cv::Mat mask(surfaces.inverse.size(), CV_8UC1, cv::Scalar(255));
  if (options_.baseline_m > 0.0) {
    const auto shift = static_cast<float>(camera_.fx_px * options_.baseline_m);
    for (int row = 0; row < mask.rows; ++row) {
      const auto* inverse = surfaces.inverse.ptr<float>(row);
      auto* returns = mask.ptr<unsigned char>(row);
      // From the right: a column of the projector that a surface has taken is dark farther away.
      float taken = std::numeric_limits<float>::infinity();
      for (int column = mask.cols - 1; column >= 0; --column) {
        if (inverse[column] <= 0.0F) continue;
        const float projector_column = static_cast<float>(column) - shift * inverse[column];
        if (projector_column > taken + 0.5F) {
          returns[column] = 0;
        } else {
          taken = std::min(taken, projector_column);
        }
      }
    }
  }
  if (!no_return.empty()) mask.setTo(0, no_return);
  return mask;
}

cv::Mat DepthNoise::fraying(const Surfaces& surfaces) {
  cv::Mat offsets(surfaces.inverse.size(), CV_16SC2, cv::Scalar::all(0));
  const double scale = camera_.width_px / kSensorWidthPx;
  const double calm = scale * options_.lateral_px, steep = scale * options_.lateral_grazing_px;
  if (calm <= 0.0 && steep <= 0.0) return offsets;
  const cv::Mat right = noiseField(scale * kFrayLengthPx), down = noiseField(scale * kFrayLengthPx);
  const int reach = kernelSize(calm);
  cv::Mat outlines;
  cv::dilate(surfaces.jump, outlines, cv::Mat::ones(reach, reach, CV_8UC1));
  const double limit = 3.0 * calm + 1.0;
  for (int row = 0; row < offsets.rows; ++row) {
    const auto* outline = outlines.ptr<unsigned char>(row);
    auto* offset = offsets.ptr<cv::Vec2s>(row);
    for (int column = 0; column < offsets.cols; ++column) {
      if (outline[column] == 0) continue;
      const double sigma_px = calm + steep * steepness(cosineOfIncidence(surfaces, row, column));
      const auto shift = [&](const cv::Mat& field, int position, int last) {
        const double wanted =
            std::clamp(sigma_px * static_cast<double>(field.at<float>(row, column)), -limit, limit);
        const int target = std::clamp(position + static_cast<int>(std::lround(wanted)), 0, last);
        return static_cast<std::int16_t>(target - position);
      };
      offset[column] = {shift(right, column, offsets.cols - 1), shift(down, row, offsets.rows - 1)};
    }
  }
  return offsets;
}

cv::Mat DepthNoise::measure(const cv::Mat& depth_m, const cv::Mat& no_return) {
  return measure(Surfaces(depth_m), no_return);
}

cv::Mat DepthNoise::measure(const Surfaces& surfaces, const cv::Mat& no_return) {
  const auto& o = options_;
  const cv::Mat& depth_m = surfaces.depth_m;
  const cv::Mat light = lit(surfaces, no_return);
  const cv::Mat noise = noiseField(o.noise_correlation_px);
  const cv::Mat offsets = fraying(surfaces);
  const double cos_start = std::cos(o.grazing_start);
  const double cos_end = std::min(std::cos(o.grazing_end), cos_start);
  const double disparity_gain =
      camera_.fx_px * kSensorWidthPx / camera_.width_px * o.baseline_m * o.disparity_steps_per_px;
  cv::Mat measured = cv::Mat::zeros(depth_m.size(), CV_16UC1);
  std::vector<float> luck_of_row(static_cast<std::size_t>(depth_m.cols));
  for (int row = 0; row < depth_m.rows; ++row) {
    random_.uniforms(luck_of_row.data(), luck_of_row.size());
    const auto* offset = offsets.ptr<cv::Vec2s>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      const int r = row + offset[column][1], c = column + offset[column][0];
      const double z = depth_m.at<float>(r, c);
      if (z < o.range_min_m || z > o.range_max_m || light.at<unsigned char>(r, c) == 0) continue;
      const double luck = luck_of_row[static_cast<std::size_t>(column)];
      if (luck < o.loss_fraction) continue;
      const double cosine = cosineOfIncidence(surfaces, r, c);
      if (cosine <= cos_end) continue;
      if (cosine < cos_start && luck > (cosine - cos_end) / (cos_start - cos_end)) continue;
      if (luck < o.edge_loss_fraction && surfaces.jump.at<unsigned char>(r, c) != 0) continue;

      // Rounding has its share of the noise: the variance of a uniform distribution, step^2 / 12.
      const double step = disparity_gain > 0.0 ? z * z / disparity_gain : 0.0;
      const double total = sigma(z, cosine);
      const double rest = std::sqrt(
          std::max(0.0, total * total - (step * step + kMillimetre * kMillimetre) / 12.0));
      double result = z + rest * static_cast<double>(noise.at<float>(row, column));
      if (disparity_gain > 0.0 && result > 0.0) {
        result = disparity_gain / std::max(1.0, rounded(disparity_gain / result));
      }
      if (result < o.range_min_m || result > o.range_max_m) continue;
      measured.at<std::uint16_t>(row, column) =
          static_cast<std::uint16_t>(result / kMillimetre + 0.5);
    }
  }
  return measured;
}

}  // namespace colonnade
