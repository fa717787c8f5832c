// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {

/// The way from a clone to the robot: all that a place seen from both, told in the clone's axes,
/// depends on. Where the clone lies in the world does not matter to it.
struct Way {
  Pose2 T_clone_robot;
  Eigen::Matrix3d covariance;
};
/// The clone must be in the state. Reads the lower triangle of P only.
Way wayFromClone(const State& state, LandmarkId clone);

}  // namespace colonnade
