// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The floor in the optical frame: up . p + height = 0.
struct FloorFit {
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  double height_m = 0.0;
  /// Of small rotations of `up` about the first and second tangent below, and of the height.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d tangent_a = Eigen::Vector3d::UnitX();  ///< up moves by this per unit
  Eigen::Vector3d tangent_b = Eigen::Vector3d::UnitZ();
  int points = 0;
};

/// How far from the expected floor to look.
struct FloorSearch {
  double tilt = 0.05;  ///< rad
  double height_m = 0.05;
};

/// Fits the floor near an expected one, or nothing when too little of it is seen.
std::optional<FloorFit> fitFloorNear(const cv::Mat& depth_m, const PinholeCamera& camera,
                                     const Eigen::Vector3d& up, double height_m,
                                     const FloorSearch& search);

}  // namespace colonnade
