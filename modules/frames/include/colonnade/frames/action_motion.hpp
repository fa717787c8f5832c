// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "colonnade/base/pose2.hpp"

namespace mrpt::obs {
class CActionCollection;
}

namespace colonnade {

/// A movement as an action states it: covariance of (x, y, phi) in the axes of the robot before it.
struct ActionMotion {
  Pose2 T_before_after;
  std::optional<Eigen::Matrix3d> covariance;
};

/// The first movement of a collection (2D, or 3D projected); a second one is another estimate of
/// the same motion. Nothing when there is none.
std::optional<ActionMotion> motionOf(const mrpt::obs::CActionCollection& actions);

}  // namespace colonnade
