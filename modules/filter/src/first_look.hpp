// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "colonnade/base/measurement.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/filter/measurement_models.hpp"

namespace colonnade {

/// Where the landmark of a measurement with range may be, by places alone: a cheap look before its
/// innovation. Rules out only points whose squared Mahalanobis distance is larger than asked for:
/// four errors that may hang together (place and heading of the robot, landmark, sensor) have at
/// most four times the sum of their variances; the rest is for what is not linear.
class FirstLook {
 public:
  static constexpr double kReserve = 5.0;

  FirstLook(const Pose2& T_world_robot, const Eigen::Matrix3d& P_robot, const Measurement& m) {
    const double range = m.z(1);
    const Eigen::Vector2d p_robot =
        range * Eigen::Vector2d(std::cos(m.z(0)), std::sin(m.z(0))) + m.p_robot_camera;
    const MeasurementCovariance R = noiseOf(m);
    p_world_ = transform(T_world_robot, p_robot);
    spread2_ = P_robot.topLeftCorner<2, 2>().trace() + p_robot.squaredNorm() * P_robot(2, 2) +
               range * range * R(0, 0) + R(1, 1);
  }

  /// A point whose two variances have this sum.
  bool rulesOut(const Eigen::Vector2d& p, double spread2, double distance2) const {
    return (p - p_world_).squaredNorm() > kReserve * distance2 * (spread2_ + spread2);
  }
  /// The same for one that may have moved so far from p. Roots are only taken where it is near:
  /// (a + b)^2 <= 2 (a^2 + b^2).
  bool rulesOut(const Eigen::Vector2d& p, double moved_m, double spread2, double distance2) const {
    const double apart2 = (p - p_world_).squaredNorm();
    const double reach2 = kReserve * distance2 * (spread2_ + spread2);
    return apart2 > 2.0 * (moved_m * moved_m + reach2) ||
           std::sqrt(apart2) > moved_m + std::sqrt(reach2);
  }

 private:
  Eigen::Vector2d p_world_;
  double spread2_;  ///< m^2, but for the point's own
};

}  // namespace colonnade
