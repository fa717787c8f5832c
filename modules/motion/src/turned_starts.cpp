// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "turned_starts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// Two pixels of the coarsest level each way, of a usual lens.
constexpr double kStep = radians(6.0);
/// As far an alignment gets by itself.
constexpr double kOwnReach = radians(9.0);
/// Farther round little is in view of both.
constexpr double kMost = radians(40.0);
constexpr double kSigmas = 2.0;

}  // namespace

std::vector<Eigen::Isometry3d> turnedStarts(const MotionPrior& prior,
                                            const Eigen::Vector3d& up_camera) {
  const Eigen::Matrix3d turns = prior.information.inverse().bottomRightCorner<3, 3>();
  const double reach = kSigmas * std::sqrt(up_camera.dot(turns * up_camera));
  std::vector<Eigen::Isometry3d> starts;
  if (reach < kOwnReach) return starts;
  for (double turn = kStep; turn <= std::min(reach, kMost); turn += kStep)
    for (const double signed_turn : {turn, -turn})
      starts.push_back(prior.T_reference_current * Eigen::AngleAxisd(signed_turn, up_camera));
  return starts;
}

}  // namespace colonnade
