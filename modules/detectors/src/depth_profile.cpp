// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_profile.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "colonnade/detectors/levelled_camera.hpp"
#include "depth_column.hpp"
#include "depth_slice_row.hpp"

namespace colonnade {
namespace {

/// All pixels, sorted into (column, band).
class Bins {
 public:
  Bins(int columns, int rows)
      : rows_(static_cast<std::size_t>(columnBlocks(rows) * kColumnBlock)),
        counts_(static_cast<std::size_t>(columns) * DepthProfile::kBands, 0),
        pixels_(std::make_unique_for_overwrite<Pixel[]>(counts_.size() * rows_)),
        all_z_(DepthProfile::kBands * rows_),
        all_offset_(all_z_.size()),
        inverse_(all_z_.size()) {}

  void add(std::size_t bin, float z, float offset) {
    if (counts_[bin] < rows_) pixels_[bin * rows_ + counts_[bin]++] = {z, offset};
  }

  /// `slope` and `slope_step`: of the middle of the column and from column to column.
  void summarise(DepthProfile::Column& column, int index, int min_pixels, double slope,
                 double slope_step) {
    std::size_t all = 0;  // with what fills the blocks of each band
    int pixels = 0;
    float least = std::numeric_limits<float>::max(), most = 0.0F;
    for (std::size_t band = 0; band < DepthProfile::kBands; ++band) {
      const std::size_t bin = static_cast<std::size_t>(index) * DepthProfile::kBands + band;
      const auto count = static_cast<int>(counts_[bin]);
      if (count == 0 || count < min_pixels) continue;
      float* const z = &all_z_[all];
      float* const offset = &all_offset_[all];
      double* const inverse = &inverse_[all];
      const Pixel* const pixels_here = &pixels_[bin * rows_];
      for (int i = 0; i < count; ++i) {
        z[i] = pixels_here[i].z;
        offset[i] = pixels_here[i].offset;
      }
      fillColumnBlock(z, offset, count);
      const int blocks = columnBlocks(count);
      inverseDepths(z, blocks, inverse);
      const ColumnMiddle middle = middleOfColumn(z, inverse, offset, blocks, count);
      column.band_z[band] = middle.z;
      column.band_slope[band] = slope + slope_step * middle.offset;
      least = std::min(least, middle.median);
      most = std::max(most, middle.median);
      all += static_cast<std::size_t>(blocks * kColumnBlock);
      pixels += count;
    }
    column.slope = slope;
    if (pixels == 0) return;
    // The median of all is between those of the parts.
    const ColumnMiddle middle =
        middleOfColumn(all_z_.data(), inverse_.data(), all_offset_.data(),
                       static_cast<int>(all) / kColumnBlock, pixels, least, most);
    column.z = middle.z;
    column.slope = slope + slope_step * middle.offset;
    column.pixels = middle.pixels;
  }

 private:
  struct Pixel {
    float z, offset;
  };
  std::size_t rows_;  ///< of a bin, whole blocks
  std::vector<std::size_t> counts_;
  std::unique_ptr<Pixel[]> pixels_;
  std::vector<float> all_z_, all_offset_;  ///< of a column
  std::vector<double> inverse_;
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
  if (options.max_height_m <= options.min_height_m) return profile;
  Bins bins(columns, (frame.depth_m.rows + options.row_step - 1) / options.row_step);
  const SliceGrid grid{
      camera.height(), options.min_height_m, options.max_height_m, DepthProfile::kBands, columns,
      middle,          profile.focal_px};
  std::vector<std::int32_t> bin(profile.columns.size());
  std::vector<float> z(bin.size()), offset(bin.size());
  std::vector<int> blocks(bin.size() / kPlacedTogether + 1);
  std::vector<RayRow> rays;  // of the rows read
  for (int v = options.row_step / 2; v < frame.depth_m.rows; v += options.row_step)
    rays.emplace_back(camera, v, forward);
  // Upright strips fill few bins at a time, which stay near.
  constexpr int kStrip_px = 8 * kPlacedTogether;
  for (int strip = 0; strip < columns; strip += kStrip_px) {
    const int strip_end = std::min(strip + kStrip_px, columns);
    int v = options.row_step / 2;
    for (const RayRow& row : rays) {
      const int count = placeRow(frame.depth_m.ptr<float>(v), strip, strip_end, row, grid,
                                 {bin.data(), z.data(), offset.data(), blocks.data()});
      for (int block = 0; block < count; ++block) {
        const auto first = static_cast<std::size_t>(blocks[static_cast<std::size_t>(block)]);
        for (std::size_t u = first; u < std::min(first + kPlacedTogether, bin.size()); ++u)
          if (bin[u] >= 0) bins.add(static_cast<std::size_t>(bin[u]), z[u], offset[u]);
      }
      v += options.row_step;
    }
  }
  for (int i = 0; i < columns; ++i) {
    bins.summarise(profile.columns[static_cast<std::size_t>(i)], i, options.min_pixels,
                   (i - middle) / profile.focal_px, 1.0 / profile.focal_px);
  }
  return profile;
}

}  // namespace colonnade
