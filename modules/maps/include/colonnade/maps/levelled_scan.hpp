// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

struct ScanOptions {
  static constexpr const char* kSection = "Scans";
  double z_min_m = 0.15;  ///< above the floor: what lies lower is taken for floor
  double z_max_m = 1.6;
  double tilt_margin = radians(1.0);  ///< error of the camera's tilt that must not raise the floor
  double min_range_m = 0.3;
  double max_range_m = 6.0;
  double beam_width = radians(0.5);
  int column_step = 2;  ///< every how many columns of the depth image are used
  int row_step = 4;
  int min_pixels = 4;  ///< used pixels that must agree on an obstacle

  void visit(OptionVisitor& v) {
    v.number("z_min_m", z_min_m, {0.02, 2}, "height of the lowest obstacle");
    v.number("z_max_m", z_max_m, {0.1, 5}, "height of the highest obstacle");
    v.angle("tilt_margin_deg", tilt_margin, {0, 10}, "tilt error that may not raise the floor");
    v.number("min_range_m", min_range_m, {0, 5}, "nearer depth is ignored");
    v.number("max_range_m", max_range_m, {0.5, 30}, "farther depth is ignored");
    v.angle("beam_width_deg", beam_width, {0.1, 5}, "between two beams");
    v.integer("column_step", column_step, {1, 16}, "1 = use every column of the depth image");
    v.integer("row_step", row_step, {1, 16}, "1 = use every row of the depth image");
    v.integer("min_pixels", min_pixels, {1, 1000}, "that must agree on an obstacle");
  }
};

/// A laser scan as it would lie in a horizontal plane around the camera's foot point: for each
/// azimuth the nearest obstacle in a band of heights.
struct LevelledScan {
  /// Origin below the camera, x axis along the levelled optical axis.
  Pose2 T_robot_scan;
  double first_angle = 0.0;  ///< of beam 0, in the scan's frame, counter-clockwise
  double step = 0.0;
  std::vector<float> ranges_m;  ///< horizontal; 0 where no obstacle was seen
  /// Where no obstacle was seen: how far the floor was, without a gap. Otherwise 0.
  std::vector<float> free_m;

  std::size_t size() const { return ranges_m.size(); }
  bool valid(std::size_t beam) const { return ranges_m[beam] > 0.0F; }
  double angle(std::size_t beam) const { return first_angle + step * static_cast<double>(beam); }
  std::size_t validBeams() const;
  Eigen::Vector2d p_robot_camera() const { return T_robot_scan.translation(); }
};

/// Cuts scans out of depth images. It keeps what depends on the camera and its tilt alone, so that
/// a frame with the same mounting costs one pass over the pixels.
class ScanCutter {
 public:
  explicit ScanCutter(const ScanOptions& options) : options_(options) {}

  /// Every used depth pixel is levelled by T_robot_camera; those whose height lies in the band fall
  /// into the beam of their azimuth. A beam takes the nearest range that enough of its pixels (3 %,
  /// `min_pixels` at least) agree on within depth noise, and of these the median, so that neither
  /// speckles nor noise pull it nearer. Nothing if the frame has no depth or no calibration. A beam
  /// that sees only floor, or nothing, stays invalid: without an obstacle nobody knows how far it
  /// is free.
  std::optional<LevelledScan> cut(const Frame& frame);

 private:
  struct Pixel {
    std::int32_t index;  ///< into the depth image
    std::int32_t beam;
    float range_per_depth;  ///< horizontal distance per metre of depth
    float rise_per_depth;   ///< height per metre of depth
  };
  void prepare(const Frame& frame);

  ScanOptions options_;
  PinholeCamera camera_;
  cv::Size depth_size_;
  Eigen::Isometry3d T_robot_camera_ = Eigen::Isometry3d::Identity();
  LevelledScan empty_;
  std::vector<Pixel> pixels_;
  std::vector<std::vector<float>> obstacles_;  ///< ranges of each beam
  std::vector<std::vector<float>> floor_;
};

}  // namespace colonnade
