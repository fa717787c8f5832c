// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "colonnade/base/measurement.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/baselines/baseline_options.hpp"
#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// One step of a range-bearing filter.
struct RangeBearingStep {
  double stamp_s = 0.0;
  Pose2 T_previous_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (x, y, phi) in the former robot's axes
  std::vector<Measurement> measurements;  ///< all with range, all from one place on the robot
  /// Full horizontal angle about the robot's heading outside which nothing can be seen: MRPT
  /// predicts and associates only landmarks inside it (and 20 degrees more).
  double field_of_view = 2.0 * kPi;
};

/// mrpt::slam::CRangeBearingKFSLAM2D behind our types. It takes every measurement it cannot
/// associate for a new landmark, at once. It does not predict while its map is empty; that motion
/// is kept here, so that nothing is lost.
class RangeBearingFilter {
 public:
  explicit RangeBearingFilter(const KfSlamOptions& options);
  ~RangeBearingFilter();

  /// The robot after the step; world: the robot before the first one. Measurements have no
  /// identity. Throws Error with MRPT's own words when the filter does.
  Pose2 step(const RangeBearingStep& step);
  LandmarkMap landmarks() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
