// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/slam/range_bearing_estimator.hpp"

namespace colonnade {

/// The experiment of the 2012 thesis (figures 5.16 to 5.20): a robot goes round a cloister and sees
/// numbered landmarks by range and bearing. The thesis states no noise; these are a small wheeled
/// robot's and a Kinect's.
struct TextbookWorld {
  double step_m = 0.1;
  int steps_a_round = 240;
  double along_m = 0.02;          ///< sigma of a step, metres
  double across_m = 0.005;        ///< metres
  double heading = radians(1.0);  ///< of a step
  double range_m = 0.1;           ///< sigma of a reading
  double bearing = radians(1.0);  ///< of a reading
  double view_m = 4.0;            ///< how far the sensor sees
  double view = radians(60.0);    ///< to either side
  std::vector<Eigen::Vector2d> landmarks() const;
};

/// One drive, estimated three ways from the same readings.
struct TextbookDrive {
  std::vector<Pose2> truth, dead_reckoning, plain, invariant;  ///< one pose a step
  LandmarkMap landmarks;                                       ///< of the invariant filter
  double nees_plain = 0.0, nees_invariant = 0.0;               ///< of the last pose, over 3
};
TextbookDrive drive(const TextbookWorld& world, int rounds, std::uint64_t seed);

}  // namespace colonnade
