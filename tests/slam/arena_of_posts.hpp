// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "wandering_robot.hpp"

namespace colonnade::testing {

/// A slow robot with a narrow view that wanders from one place to another among posts anywhere,
/// with wheels that turn badly: as the robots of UTIAS MRCLAM data set 7 do.
class ArenaOfPosts : public WanderingRobot {
 public:
  static constexpr double kWidth_m = 5.0, kLength_m = 8.0, kInterval_s = 0.5;
  static constexpr double kNeighbours_m = 0.3;
  static constexpr std::size_t kPosts = 15;

  /// cluster: so many posts stand together, kNeighbours_m apart.
  explicit ArenaOfPosts(unsigned seed, std::size_t steps = 600, std::size_t cluster = 1,
                        double share_read = 0.5)
      : WanderingRobot(seed, steps, {kInterval_s, 0.05, radians(0.6)}), share_read_(share_read) {
    for (std::size_t i = 0; i < kPosts; ++i)
      posts_[i] = i % cluster == 0 ? somewhere(0.0) : posts_[i - 1] + neighbour();
    T_world_robot_ = {kWidth_m / 2.0, kLength_m / 2.0, 0.0};
    goal_ = somewhere(0.5);
  }

 private:
  Eigen::Vector2d somewhere(double margin_m) {
    const double x = uniform(margin_m, kWidth_m - margin_m);
    return {x, uniform(margin_m, kLength_m - margin_m)};
  }

  Eigen::Vector2d neighbour() {
    return Eigen::Rotation2Dd(uniform(-kPi, kPi)) * Eigen::Vector2d(kNeighbours_m, 0.0);
  }

  void drive() override {
    if ((goal_ - T_world_robot_.translation()).norm() < 0.3) goal_ = somewhere(0.5);
    const double direction = directionOf(goal_);
    const double way = std::abs(direction) > 0.8 ? 0.0 : 0.1 * kInterval_s;
    const double turn = std::clamp(direction, -0.3, 0.3) * kInterval_s;
    move(way, turn,
         {std::hypot(0.05 * std::sqrt(way), 0.001), std::hypot(0.02 * std::sqrt(way), 0.001),
          std::sqrt(way * std::pow(radians(3.0), 2) + std::abs(turn) * std::pow(radians(6.0), 2) +
                    std::pow(radians(0.1), 2))});
  }

  void look(std::vector<RangeBearing>& readings) override {
    for (std::size_t i = 0; i < kPosts; ++i) {
      const double distance = (posts_[i] - T_world_robot_.translation()).norm();
      if (distance > 4.0 || distance < 0.3 || std::abs(directionOf(posts_[i])) > 0.5 ||
          uniform(0.0, 1.0) < 1.0 - share_read_)
        continue;
      read(i + 1, posts_[i], readings);
    }
  }

  std::vector<Eigen::Vector2d> posts_ = std::vector<Eigen::Vector2d>(kPosts);
  Eigen::Vector2d goal_;
  double share_read_;
};

}  // namespace colonnade::testing
