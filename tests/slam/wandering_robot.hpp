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

/// A robot that goes from one place to another anywhere and reads posts, with the truth beside it.
class WanderingRobot : public FrameSource {
 public:
  struct Senses {
    double interval_s, range_sigma_m, bearing_sigma;
  };
  WanderingRobot(unsigned seed, std::size_t frames, const Senses& senses)
      : random_(seed), senses_(senses), frames_(frames) {}

  std::optional<Frame> next() override {
    if (truth.size() == frames_) return std::nullopt;
    Frame frame;
    frame.stamp_s = senses_.interval_s * static_cast<double>(truth.size() + 1);
    if (!truth.empty()) drive();
    frame.odometry = OdometryReading{T_world_odometry_, motion_covariance_};
    frame.range_bearing.emplace();
    frame.range_bearing->range_sigma_m = senses_.range_sigma_m;
    frame.range_bearing->yaw_sigma = senses_.bearing_sigma;
    look(frame.range_bearing->readings);
    truth.push_back({frame.stamp_s, T_world_robot_.toIsometry3()});
    return frame;
  }
  const Damage& damage() const override { return damage_; }
  double progress() const override { return 0.0; }

  Trajectory truth;

 protected:
  virtual void drive() = 0;
  virtual void look(std::vector<RangeBearing>& readings) = 0;

  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }
  /// Towards a point in the robot's axes, at 0 from its heading.
  double directionOf(const Eigen::Vector2d& p_world) const {
    const Eigen::Vector2d ahead = transform(T_world_robot_.inverse(), p_world);
    return std::atan2(ahead.y(), ahead.x());
  }
  void move(double way, double turn, const Eigen::Vector3d& sigma) {
    motion_covariance_ = sigma.cwiseAbs2().asDiagonal();
    T_world_robot_ = T_world_robot_ * Pose2{way, 0.0, turn};
    T_world_odometry_ =
        T_world_odometry_ * Pose2{way + gauss(sigma(0)), gauss(sigma(1)), turn + gauss(sigma(2))};
  }
  void read(std::size_t identity, const Eigen::Vector2d& post,
            std::vector<RangeBearing>& readings) {
    const Eigen::Vector2d p = transform(T_world_robot_.inverse(), post);
    readings.push_back({static_cast<std::int32_t>(identity),
                        p.norm() + gauss(senses_.range_sigma_m),
                        std::atan2(p.y(), p.x()) + gauss(senses_.bearing_sigma),
                        0.0,
                        {}});
  }

  Pose2 T_world_robot_;

 private:
  std::mt19937 random_;
  Senses senses_;
  std::size_t frames_;
  Pose2 T_world_odometry_;
  Eigen::Matrix3d motion_covariance_ = 1e-6 * Eigen::Matrix3d::Identity();
  Damage damage_;
};

}  // namespace colonnade::testing
