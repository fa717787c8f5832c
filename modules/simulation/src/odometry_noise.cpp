// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/odometry_noise.hpp"

#include <cmath>

namespace colonnade {
namespace {

double squared(double x) { return x * x; }

/// What encoders resolve: keeps the stated covariance positive while the robot stands still.
constexpr double kEncoderStepM = 1e-4;
constexpr double kEncoderStepRad = 2e-4;

}  // namespace

MeasuredIncrement OdometryNoise::measure(const Pose2& T_previous_robot) {
  const auto& o = options_;
  const Eigen::Vector3d moved = T_previous_robot.vector();
  const double distance = moved.head<2>().norm();
  const double turn = std::abs(moved.z());

  const Eigen::Vector3d systematic(o.scale * moved.x(), o.scale * moved.y(),
                                   o.turn_bias_per_m * distance + o.turn_scale * moved.z());
  const Eigen::Vector3d variance(
      squared(o.forward_noise_m) * distance, squared(o.sideways_noise_m) * distance,
      squared(o.turn_noise_per_m) * distance + squared(o.turn_noise_per_rad) * turn);

  MeasuredIncrement measured;
  Eigen::Vector3d value = moved + systematic;
  for (int i = 0; i < 3; ++i) value[i] += std::sqrt(variance[i]) * random_.normal();
  measured.T_previous_robot = {value.x(), value.y(), wrapAngle(value.z())};

  // An error e per metre that stays the same over L metres and is then drawn anew grows, over many
  // steps of length d, like independent errors of variance e^2 L d each.
  const double reach = distance * o.stated_correlation_m;
  measured.covariance.diagonal() =
      variance +
      Eigen::Vector3d(squared(o.scale) * reach + squared(kEncoderStepM), squared(kEncoderStepM),
                      squared(o.turn_bias_per_m) * reach +
                          squared(o.turn_scale) * turn * 0.5 * kPi + squared(kEncoderStepRad));
  return measured;
}

}  // namespace colonnade
