// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_book.hpp"

namespace colonnade {

/// Two landmarks of the map held to be one: `twin` was born when `kept` was not recognised.
struct Twins {
  LandmarkId kept{};
  LandmarkId twin{};
};

/// How far twins are apart: two numbers, zero for the same thing.
///   points  p_twin - p_kept
///   lines   (difference of direction modulo pi, distance of the middle of the twin's seen part
///           from the kept line)
struct TwinDifference {
  Eigen::Vector2d difference = Eigen::Vector2d::Zero();
  Eigen::MatrixXd H_kept;  ///< 2 x size of the block
  Eigen::MatrixXd H_twin;
  int offset_kept = 0;  ///< of the blocks in the state
  int offset_twin = 0;
  /// Derivative in a motion (x, y, turn about the robot) of all that stands where the twin does.
  Eigen::Matrix<double, 2, 3> J_drift;
  bool is_line = false;
  Eigen::Vector2d p_kept = Eigen::Vector2d::Zero();  ///< world; lines: nearest to the twin
};
/// Nothing when they are of different kinds or one of them has no place yet.
std::optional<TwinDifference> differenceOf(const State& state, const Twins& twins);

/// All differences as one linear function of the state.
SparseJacobian stacked(std::span<const TwinDifference> differences);

/// Standard deviations between two estimates of one thing that no number of observations averages
/// out: calibration, and from where it was looked at.
struct TwinNoise {
  double place_m = 0.02;
  double direction = 0.01;  ///< rad
  Eigen::Matrix2d covariance(bool is_line) const;
};

/// Makes every twin one with its kept landmark: one joint correction that says so, then the twins
/// leave the state. What was seen of them stays known. False, and nothing changed, when the
/// correction is impossible.
bool fuse(std::span<const Twins> twins, const TwinNoise& noise, EkfSlam& filter,
          LandmarkBook& book);

}  // namespace colonnade
