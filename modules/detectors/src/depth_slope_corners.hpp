// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "colonnade/detectors/depth_slope_detector.hpp"
#include "depth_slope_segments.hpp"

namespace colonnade {

/// A corner of the slice.
struct SliceCorner {
  double s = 0.0;                                        ///< x / z
  double q = 0.0;                                        ///< 1 / z
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (s, q)
  bool jump = false;                       ///< the end of a surface before a farther one
  bool far_on_right = false;               ///< of jumps
  double step_m = 0.0;                     ///< of jumps: how much farther
  double turn = 0.0;                       ///< of others: angle between the surfaces
  std::optional<InverseLine> left, right;  ///< what was measured beside it
  double noise_scale = 1.0;                ///< of the variances of this frame's columns
  double noise_shared = 1.0;               ///< columns that have one error in common
  std::string refusal;

  Eigen::Vector2d p_slice() const { return Eigen::Vector2d(s, 1.0) / q; }
};

/// Where two lines meet, with the covariance; nothing for parallel ones.
std::optional<SliceCorner> intersection(const InverseLine& left, const InverseLine& right,
                                        double shared_columns);

/// All corners between neighbouring surfaces, left to right.
std::vector<SliceCorner> findCorners(const DepthProfile& profile, const InverseColumns& columns,
                                     const DepthSlopeOptions& options);

}  // namespace colonnade
