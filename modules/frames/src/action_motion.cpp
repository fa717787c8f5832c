// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/action_motion.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <array>

#include "camera_views.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

std::optional<Eigen::Matrix3d> usable(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite() || covariance.isZero(0.0)) return std::nullopt;
  return covariance;
}

ActionMotion motionOf(const CActionRobotMovement2D& movement) {
  mrpt::poses::CPose2D mean;
  mrpt::math::CMatrixDouble33 covariance;
  movement.poseChange->getCovarianceAndMean(covariance, mean);
  // Of odometry MRPT stores the reading and draws particles anew on loading when the model is
  // Thrun's: the reading is exact, the particles' covariance would change from load to load.
  const bool odometry = movement.estimationMethod == CActionRobotMovement2D::emOdometry;
  const bool drawn = odometry && movement.motionModelConfiguration.modelSelection !=
                                     CActionRobotMovement2D::mmGaussian;
  if (odometry) mean = movement.rawOdometryIncrementReading;
  return {{mean.x(), mean.y(), mean.phi()}, drawn ? std::nullopt : usable(covariance.asEigen())};
}

ActionMotion motionOf(const CActionRobotMovement3D& movement) {
  const auto& all = movement.poseChange.cov;  // x y z yaw pitch roll
  constexpr std::array<int, 3> kPlanar{0, 1, 3};
  Eigen::Matrix3d covariance;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      covariance(static_cast<int>(row), static_cast<int>(column)) =
          all(kPlanar[row], kPlanar[column]);
  return {planarPart(toIsometry(movement.poseChange.mean)), usable(covariance)};
}

}  // namespace

std::optional<ActionMotion> motionOf(const mrpt::obs::CActionCollection& actions) {
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const mrpt::obs::CAction* action = &actions.get(i);
    if (const auto* flat = dynamic_cast<const CActionRobotMovement2D*>(action))
      if (flat->poseChange) return motionOf(*flat);
    if (const auto* solid = dynamic_cast<const CActionRobotMovement3D*>(action))
      return motionOf(*solid);
  }
  return std::nullopt;
}

}  // namespace colonnade
