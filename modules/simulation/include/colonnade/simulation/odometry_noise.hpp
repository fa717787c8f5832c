// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/pose2.hpp"
#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// A motion as the wheels report it.
struct MeasuredIncrement {
  Pose2 T_previous_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (x, y, phi), as stated in the log
};

/// Wheel odometry with systematic and random errors (see OdometryOptions).
class OdometryNoise {
 public:
  OdometryNoise(const OdometryOptions& options, std::uint64_t seed)
      : options_(options), random_(seed, "odometry") {}

  MeasuredIncrement measure(const Pose2& T_previous_robot);

 private:
  OdometryOptions options_;
  Random random_;
};

}  // namespace colonnade
