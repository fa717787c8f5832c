// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/filter/sensor_errors.hpp"
#include "colonnade/frames/frame_source.hpp"

namespace colonnade::testing {

/// A robot that drives rounds in a ring of posts and sees those in front of it. A round starts at
/// the origin.
class RingOfPosts : public FrameSource {
 public:
  explicit RingOfPosts(unsigned seed, std::size_t first_step = 0, std::size_t steps = 2 * kSteps,
                       double reach_m = 3.0, double half_angle = 0.7)
      : steps_(steps), reach_m_(reach_m), half_angle_(half_angle), random_(seed) {
    T_world_robot_ = poseAfter(first_step);
  }

  std::optional<Frame> next() override {
    if (truth.size() == steps_) return std::nullopt;
    T_world_robot_ = T_world_robot_ * kWay;
    T_world_odometry_ = T_world_odometry_ * Pose2{kWay.x * (1.0 + gauss(wheel_noise)), gauss(0.004),
                                                  kWay.phi + gauss(0.01)};
    Frame frame;
    frame.stamp_s = 0.5 * static_cast<double>(truth.size() + 1);
    frame.odometry = OdometryReading{T_world_odometry_, {}};
    frame.range_bearing.emplace();
    frame.range_bearing->range_sigma_m = 0.05;
    frame.range_bearing->yaw_sigma = radians(1.0);
    frame.range_bearing->T_robot_sensor =
        Eigen::AngleAxisd(direction, Eigen::Vector3d::UnitZ()) * Eigen::Isometry3d::Identity();
    const Pose2 T_world_sensor = T_world_robot_ * Pose2{0.0, 0.0, direction};
    for (int i = 0; i < kPosts; ++i) {
      const Eigen::Vector2d p = transform(T_world_sensor.inverse(), post(i + 1));
      const double bearing = std::atan2(p.y(), p.x());
      if (truth.size() < blind || p.norm() > reach_m_ || std::abs(bearing) > half_angle_) continue;
      const double gain = 1.0 + sensor.range_scale + sensor.range_skew * bearing;
      frame.range_bearing->readings.push_back(
          {i + 1,
           gain * p.norm() + sensor.range_offset_m + gauss(0.05),
           (1.0 + sensor.bearing_scale) * bearing + sensor.bearing_offset + gauss(radians(1.0)),
           0.0,
           {}});
    }
    if (truth.size() == ghost_at || truth.size() == ghost_at + 1)  // 3 m apart
      frame.range_bearing->readings.push_back(
          {kPosts + 1, 2.0, truth.size() == ghost_at ? 0.8 : -0.8, 0.0, {}});
    truth.push_back({frame.stamp_s, T_world_robot_.toIsometry3()});
    return frame;
  }
  const Damage& damage() const override { return damage_; }
  double progress() const override { return 0.0; }

  /// By its identity, which starts at 1.
  static Eigen::Vector2d post(int identity) {
    const double angle = 2.0 * kPi * (identity - 1) / kPosts;
    const double radius = identity % 2 == 1 ? 5.5 : 2.0;
    return {radius * std::sin(angle), kRadius_m - radius * std::cos(angle)};
  }

  static Pose2 poseAfter(std::size_t steps) {
    Pose2 T_world_robot;
    for (std::size_t i = 0; i < steps; ++i) T_world_robot = T_world_robot * kWay;
    return T_world_robot;
  }

  static constexpr std::size_t kSteps = 120;  ///< of a round
  static constexpr int kPosts = 24;
  Trajectory truth;
  std::size_t blind = 0;     ///< frames at the start that show nothing
  double wheel_noise = 0.1;  ///< share of the way
  double direction = 0.0;    ///< of the sensor
  SensorErrors sensor;       ///< what the readings are always off by
  /// A frame after which a post that is none is seen at two places.
  std::size_t ghost_at = std::numeric_limits<std::size_t>::max() - 1;

 private:
  static constexpr Pose2 kWay{0.2, 0.0, 2.0 * kPi / kSteps};
  static constexpr double kRadius_m = 0.2 * kSteps / (2.0 * kPi);
  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

  std::size_t steps_;
  double reach_m_, half_angle_;
  std::mt19937 random_;
  Pose2 T_world_robot_, T_world_odometry_;
  Damage damage_;
};

}  // namespace colonnade::testing
