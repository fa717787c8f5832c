// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_profile.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "colonnade/detectors/levelled_camera.hpp"
#include "depth_column.hpp"
#include "depth_slice_row.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kBands = DepthProfile::kBands;

/// All pixels, sorted into columns and bands.
class Bins {
 public:
  /// rows: the pixels a bin has room for, and some more: two of a row may fall into one.
  Bins(int columns, int rows)
      : rows_(static_cast<std::size_t>(rows + 7) / 8 * 8),
        counts_(kBands * static_cast<std::size_t>(columns / kColumnsTogether + 1)),
        slots_(std::make_unique_for_overwrite<DepthSlot[]>(counts_.size() * rows_)),
        inverse_(kBands * rows_) {}

  void add(std::size_t bin, float z, float offset) {
    const std::size_t group = bin / kColumnsTogether, column = bin % kColumnsTogether;
    auto& count = counts_[group][column];
    const auto place = static_cast<std::size_t>(count);
    if (place >= rows_) return;
    DepthSlot& slot = slots_[group * rows_ + place];
    slot.z[column] = z;
    slot.offset[column] = offset;
    ++count;
  }

  /// The columns from kColumnsTogether * index on. Their slopes must be those of their middles;
  /// slope_step: from column to column.
  void summarise(std::span<DepthProfile::Column> columns, std::size_t index, int min_pixels,
                 double slope_step) {
    std::array<ColumnPart, kBands> parts;
    std::array<ColumnMiddles, kBands> middles;
    ColumnCounts all{};
    std::array<float, kColumnsTogether> least, most;
    least.fill(std::numeric_limits<float>::max());
    most.fill(0.0F);
    for (std::size_t band = 0; band < kBands; ++band) {
      const std::size_t group = index * kBands + band;
      DepthSlot* const slots = &slots_[group * rows_];
      InverseSlot* const inverse = &inverse_[band * rows_];
      ColumnCounts& pixels = counts_[group];
      for (auto& count : pixels) count = count < min_pixels ? 0 : count;
      const int count = slotsOf(pixels);
      fillSlots(slots, count, pixels);
      inverseDepths(slots, count, inverse);
      parts[band] = {slots, inverse, count};
      middles[band] = middlesOfColumns({&parts[band], 1}, pixels);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (pixels[i] == 0) continue;
        columns[i].band_z[band] = middles[band].z[i];
        columns[i].band_slope[band] = columns[i].slope + slope_step * middles[band].offset[i];
        // The median of all is between those of the parts.
        least[i] = std::min(least[i], middles[band].median[i]);
        most[i] = std::max(most[i], middles[band].median[i]);
        all[i] += pixels[i];
      }
    }
    const ColumnMiddles middle = middlesOfColumns(parts, all, least, most);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (all[i] == 0) continue;
      columns[i].z = middle.z[i];
      columns[i].slope += slope_step * middle.offset[i];
      columns[i].pixels = middle.pixels[i];
    }
  }

 private:
  std::size_t rows_;                    ///< of a bin, whole groups of four
  std::vector<ColumnCounts> counts_;    ///< of the bins of neighbouring columns
  std::unique_ptr<DepthSlot[]> slots_;  ///< rows_ for each of those
  std::vector<InverseSlot> inverse_;    ///< of kColumnsTogether columns
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
  std::vector<int> blocks(profile.columns.size() / kPlacedTogether + 1);
  std::vector<std::int32_t> bin(blocks.size() * kPlacedTogether);
  std::vector<float> z(bin.size()), offset(bin.size());
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
        for (std::size_t u = first; u < first + kPlacedTogether; ++u)
          if (bin[u] >= 0) bins.add(static_cast<std::size_t>(bin[u]), z[u], offset[u]);
      }
      v += options.row_step;
    }
  }
  for (int i = 0; i < columns; ++i)
    profile.columns[static_cast<std::size_t>(i)].slope = (i - middle) / profile.focal_px;
  const std::span<DepthProfile::Column> all = profile.columns;
  for (std::size_t first = 0; first < all.size(); first += kColumnsTogether)
    bins.summarise(all.subspan(first, std::min<std::size_t>(kColumnsTogether, all.size() - first)),
                   first / kColumnsTogether, options.min_pixels, 1.0 / profile.focal_px);
  return profile;
}

}  // namespace colonnade
