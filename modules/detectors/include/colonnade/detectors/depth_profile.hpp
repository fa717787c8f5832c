// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Where the depth slice is taken.
struct DepthProfileOptions {
  static constexpr const char* kSection = "DepthProfile";
  double min_height_m = 0.3;  ///< of the slice above the floor
  double max_height_m = 1.5;
  int row_step = 3;    ///< rows read
  int min_pixels = 3;  ///< of a column in one band

  void visit(OptionVisitor& v) {
    v.number("min_height_m", min_height_m, {0.02, 5}, "lower end of the slice above the floor");
    v.number("max_height_m", max_height_m, {0.05, 5}, "upper end of the slice");
    v.integer("row_step", row_step, {1, 20}, "every so many rows are read");
    v.integer("min_pixels", min_pixels, {1, 100}, "depth pixels a column needs in a band");
  }
};

/// The depth image as a horizontal slice: one point for each column of an upright virtual camera
/// that looks along the levelled optical axis. x is to the right, z forward, metres from the
/// optical centre.
struct DepthProfile {
  static constexpr int kBands = 3;  ///< equal parts of the height range, lowest first
  struct Column {
    double slope = 0.0;  ///< x / z, mean of the rays that z comes from
    double z = 0.0;      ///< harmonic mean over all heights, without outliers; 0 = not measured
    std::array<double, kBands> band_z{};      ///< the same in each band
    std::array<double, kBands> band_slope{};  ///< and their slopes
    int pixels = 0;                           ///< that z is the mean of
    double x() const { return slope * z; }
    Eigen::Vector2d point() const { return {x(), z}; }
    bool valid() const { return z > 0.0; }
  };
  std::vector<Column> columns;                                  ///< left to right
  Eigen::Matrix2d R_robot_slice = Eigen::Matrix2d::Identity();  ///< (x, z) to the robot's (x, y)
  Eigen::Vector2d p_robot_camera = Eigen::Vector2d::Zero();
  double focal_px = 0.0;

  bool empty() const { return columns.empty(); }
  Eigen::Vector2d toRobot(const Eigen::Vector2d& p_slice) const {
    return p_robot_camera + R_robot_slice * p_slice;
  }
};

/// O(pixels). Empty without depth or when the camera looks straight up or down.
DepthProfile makeDepthProfile(const Frame& frame, const DepthProfileOptions& options);

}  // namespace colonnade
