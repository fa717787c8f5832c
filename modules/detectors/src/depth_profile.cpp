// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_profile.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr double kNearest_m = 0.2;
constexpr double kFarthest_m = 15.0;

struct Sample {
  float z = 0.0F;       ///< forward, m
  float offset = 0.0F;  ///< of the ray from the middle of its column, columns
};

/// All pixels, sorted into (column, band).
class Bins {
 public:
  Bins(int columns, int rows)
      : rows_(static_cast<std::size_t>(rows)),
        counts_(static_cast<std::size_t>(columns) * DepthProfile::kBands, 0),
        values_(std::make_unique_for_overwrite<Sample[]>(counts_.size() * rows_)) {}

  void add(int column, int band, Sample sample) {
    const std::size_t bin =
        static_cast<std::size_t>(column) * DepthProfile::kBands + static_cast<std::size_t>(band);
    if (counts_[bin] < rows_) values_[bin * rows_ + counts_[bin]++] = sample;
  }

  /// `slope` and `slope_step`: of the middle of the column and from column to column.
  void summarise(DepthProfile::Column& column, int index, int min_pixels, double slope,
                 double slope_step) {
    all_.clear();
    for (std::size_t band = 0; band < DepthProfile::kBands; ++band) {
      const std::size_t bin = static_cast<std::size_t>(index) * DepthProfile::kBands + band;
      if (static_cast<int>(counts_[bin]) < min_pixels) continue;
      const Sample* const first = values_.get() + bin * rows_;
      band_.assign(first, first + counts_[bin]);
      all_.insert(all_.end(), band_.begin(), band_.end());
      const Middle middle = middleOf(band_);
      column.band_z[band] = middle.z;
      column.band_slope[band] = slope + slope_step * middle.offset;
    }
    const Middle middle = middleOf(all_);
    column.z = middle.z;
    column.slope = slope + slope_step * middle.offset;
    column.pixels = middle.pixels;
  }

 private:
  struct Middle {
    double z = 0.0;
    double offset = 0.0;
    int pixels = 0;
  };

  /// The mean inverse depth of what lies within three sigma of the median. Depth comes in steps of
  /// disparity that are wider than its noise averaged over a column: a median would keep the steps.
  /// An upright plane is straight in inverse depth over the offset, so the means of both lie on it.
  Middle middleOf(const std::vector<Sample>& samples) {
    if (samples.empty()) return {};
    z_.resize(samples.size());
    std::transform(samples.begin(), samples.end(), z_.begin(), [](const Sample& s) { return s.z; });
    const double median = static_cast<double>(medianOf(z_));
    const double reach = 3.0 * kinectDepthSigma(median);
    double sum = 0.0, offsets = 0.0;
    int pixels = 0;
    for (const Sample& sample : samples) {
      const auto z = static_cast<double>(sample.z);
      if (std::abs(z - median) > reach) continue;
      sum += 1.0 / z;
      offsets += static_cast<double>(sample.offset);
      ++pixels;
    }
    return {pixels / sum, offsets / pixels, pixels};
  }

  std::size_t rows_;
  std::vector<std::size_t> counts_;
  std::unique_ptr<Sample[]> values_;
  std::vector<Sample> band_;
  std::vector<Sample> all_;
  std::vector<float> z_;
};

}  // namespace

DepthProfile makeDepthProfile(const Frame& frame, const DepthProfileOptions& options) {
  DepthProfile profile;
  if (frame.depth_m.empty() || frame.depth_m.type() != CV_32FC1) return profile;
  const LevelledCamera camera(frame);
  const Eigen::Vector3d axis = frame.T_robot_camera.linear().col(2);
  const double level = axis.head<2>().norm();
  constexpr double kLevelEnough = 0.2;
  if (level < kLevelEnough) return profile;
  const Eigen::Vector2d forward = axis.head<2>() / level;
  const Eigen::Vector2d right(forward.y(), -forward.x());
  profile.R_robot_slice.col(0) = right;
  profile.R_robot_slice.col(1) = forward;
  profile.p_robot_camera = camera.centre().head<2>();
  profile.focal_px = frame.camera.fx_px;

  const int columns = frame.depth_m.cols;
  const double middle = frame.camera.cx_px;
  profile.columns.resize(static_cast<std::size_t>(columns));
  Bins bins(columns, (frame.depth_m.rows + options.row_step - 1) / options.row_step);
  const double band_height = (options.max_height_m - options.min_height_m) / DepthProfile::kBands;
  if (band_height <= 0.0) return profile;
  for (int v = options.row_step / 2; v < frame.depth_m.rows; v += options.row_step) {
    const auto* depth_m = frame.depth_m.ptr<float>(v);
    const Eigen::Vector3d first = camera.ray(0.0, v);
    const Eigen::Vector3d step = camera.ray(1.0, v) - first;
    // Of the ray of column u: up, ahead and to the right, each first + u * step.
    const double ahead_first = forward.dot(first.head<2>());
    const double ahead_step = forward.dot(step.head<2>());
    const double right_first = right.dot(first.head<2>());
    const double right_step = right.dot(step.head<2>());
    for (int u = 0; u < columns; ++u) {
      const auto depth = static_cast<double>(depth_m[u]);
      if (!(depth > kNearest_m && depth < kFarthest_m)) continue;  // also NaN
      const double height = camera.height() + depth * (first.z() + u * step.z());
      if (height < options.min_height_m || height >= options.max_height_m) continue;
      const double ahead = ahead_first + u * ahead_step;
      if (ahead < 0.1) continue;
      const double column = middle + profile.focal_px * (right_first + u * right_step) / ahead;
      if (!(column > -0.5 && column < columns - 0.5)) continue;
      const auto index = static_cast<int>(column + 0.5);
      const int band = std::min(static_cast<int>((height - options.min_height_m) / band_height),
                                DepthProfile::kBands - 1);
      bins.add(index, band,
               {static_cast<float>(depth * ahead), static_cast<float>(column - index)});
    }
  }
  for (int i = 0; i < columns; ++i) {
    bins.summarise(profile.columns[static_cast<std::size_t>(i)], i, options.min_pixels,
                   (i - middle) / profile.focal_px, 1.0 / profile.focal_px);
  }
  return profile;
}

}  // namespace colonnade
