// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/frame_source.hpp"

namespace colonnade::testing {

/// A slow robot with a narrow view that wanders from one place to another among posts anywhere,
/// with wheels that turn badly: as the robots of UTIAS MRCLAM data set 7 do.
class ArenaOfPosts : public FrameSource {
 public:
  static constexpr double kWidth_m = 5.0, kLength_m = 8.0, kInterval_s = 0.5;
  static constexpr std::size_t kPosts = 15;

  explicit ArenaOfPosts(unsigned seed, std::size_t steps = 600) : steps_(steps), random_(seed) {
    for (Eigen::Vector2d& post : posts_) post = somewhere(0.0);
    T_world_robot_ = {kWidth_m / 2.0, kLength_m / 2.0, 0.0};
    goal_ = somewhere(0.5);
  }

  std::optional<Frame> next() override {
    if (truth.size() == steps_) return std::nullopt;
    Frame frame;
    frame.stamp_s = kInterval_s * static_cast<double>(truth.size() + 1);
    if (!truth.empty()) drive();
    frame.odometry = OdometryReading{T_world_odometry_, motion_covariance_};
    frame.range_bearing.emplace();
    frame.range_bearing->range_sigma_m = 0.05;
    frame.range_bearing->yaw_sigma = kBearingSigma;
    for (std::size_t i = 0; i < kPosts; ++i) {
      const Eigen::Vector2d p = transform(T_world_robot_.inverse(), posts_[i]);
      const double bearing = std::atan2(p.y(), p.x());
      if (p.norm() > 4.0 || p.norm() < 0.3 || std::abs(bearing) > 0.5 || uniform(0.0, 1.0) < 0.5)
        continue;
      frame.range_bearing->readings.push_back({static_cast<std::int32_t>(i + 1),
                                               p.norm() + gauss(0.05),
                                               bearing + gauss(kBearingSigma),
                                               0.0,
                                               {}});
    }
    truth.push_back({frame.stamp_s, T_world_robot_.toIsometry3()});
    return frame;
  }
  const Damage& damage() const override { return damage_; }
  double progress() const override { return 0.0; }

  Trajectory truth;

 private:
  static constexpr double kBearingSigma = radians(0.6);

  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }
  Eigen::Vector2d somewhere(double margin_m) {
    const double x = uniform(margin_m, kWidth_m - margin_m);
    return {x, uniform(margin_m, kLength_m - margin_m)};
  }

  void drive() {
    if ((goal_ - T_world_robot_.translation()).norm() < 0.3) goal_ = somewhere(0.5);
    const Eigen::Vector2d ahead = transform(T_world_robot_.inverse(), goal_);
    const double direction = std::atan2(ahead.y(), ahead.x());
    const double way = std::abs(direction) > 0.8 ? 0.0 : 0.1 * kInterval_s;
    const double turn = std::clamp(direction, -0.3, 0.3) * kInterval_s;
    const Eigen::Vector3d sigma(
        std::hypot(0.05 * std::sqrt(way), 0.001), std::hypot(0.02 * std::sqrt(way), 0.001),
        std::sqrt(way * std::pow(radians(3.0), 2) + std::abs(turn) * std::pow(radians(6.0), 2) +
                  std::pow(radians(0.1), 2)));
    motion_covariance_ = sigma.cwiseAbs2().asDiagonal();
    T_world_robot_ = T_world_robot_ * Pose2{way, 0.0, turn};
    T_world_odometry_ =
        T_world_odometry_ * Pose2{way + gauss(sigma(0)), gauss(sigma(1)), turn + gauss(sigma(2))};
  }

  std::size_t steps_;
  std::mt19937 random_;
  std::vector<Eigen::Vector2d> posts_ = std::vector<Eigen::Vector2d>(kPosts);
  Eigen::Vector2d goal_;
  Pose2 T_world_robot_, T_world_odometry_;
  Eigen::Matrix3d motion_covariance_ = 1e-6 * Eigen::Matrix3d::Identity();
  Damage damage_;
};

}  // namespace colonnade::testing
