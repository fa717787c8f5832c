// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include "colonnade/base/trajectory.hpp"

namespace colonnade::testing {

inline StampedPose at(double stamp_s, double x, double y, double phi) {
  return {stamp_s, Pose2{x, y, phi}.toIsometry3()};
}

/// 20 s at 10 Hz along x, 1 m/s.
inline Trajectory straight() {
  Trajectory path;
  for (int i = 0; i <= 200; ++i) path.push_back(at(0.1 * i, 0.1 * i, 0.0, 0.0));
  return path;
}

/// 20 s at 10 Hz, 1 m/s, along a winding path.
inline Trajectory winding() {
  Trajectory path;
  Pose2 pose;
  for (int i = 0; i <= 200; ++i) {
    path.push_back({0.1 * i, pose.toIsometry3()});
    pose = pose * Pose2{0.1, 0.0, 0.05 * std::sin(0.05 * i)};
  }
  return path;
}

/// Noise of 2 cm and 1 degree on every pose, always the same.
inline Trajectory noisy(Trajectory path) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  for (auto& pose : path) {
    const Pose2 error{0.02 * noise(random), 0.02 * noise(random), 0.017 * noise(random)};
    pose.T_world_body = pose.T_world_body * error.toIsometry3();
  }
  return path;
}

inline Trajectory moved(const Eigen::Isometry3d& motion, Trajectory path) {
  for (auto& pose : path) pose.T_world_body = motion * pose.T_world_body;
  return path;
}

}  // namespace colonnade::testing
