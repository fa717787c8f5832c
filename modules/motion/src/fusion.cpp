// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fusion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// A conflict says little about which of the two is wrong. To cover what the camera says would let
/// one bad alignment open all gates.
constexpr double kDoubtInWheels = 4.0;

}  // namespace

void doubt(MotionIncrement& wheels) { wheels.covariance *= kDoubtInWheels; }

MotionIncrement fuse(const MotionIncrement& wheels, const MotionIncrement& camera) {
  const Eigen::Matrix3d S = wheels.covariance + camera.covariance;
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  if (llt.info() != Eigen::Success) return wheels;
  Eigen::Vector3d difference = camera.T_previous_robot.vector() - wheels.T_previous_robot.vector();
  difference.z() = wrapAngle(difference.z());
  const double surprise = difference.dot(llt.solve(difference));

  MotionIncrement fused = wheels;
  if (!(surprise <= kConflict)) {
    doubt(fused);
    return fused;
  }
  const Eigen::Matrix3d K = llt.solve(wheels.covariance).transpose();
  const Eigen::Vector3d step = K * difference;
  fused.T_previous_robot.x += step.x();
  fused.T_previous_robot.y += step.y();
  fused.T_previous_robot.phi = wrapAngle(fused.T_previous_robot.phi + step.z());
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K;
  fused.covariance = A * wheels.covariance * A.transpose() + K * camera.covariance * K.transpose();
  fused.covariance *= std::max(1.0, surprise / kUsual);
  fused.source = MotionSource::kOdometryVisual;
  return fused;
}

}  // namespace colonnade
