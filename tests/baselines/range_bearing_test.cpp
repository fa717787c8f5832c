// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "range_bearing_filter.hpp"

namespace colonnade {
namespace {

constexpr double kCircle_m = 3.0;

/// A robot on a circle among landmarks 6 m across, which it sees within 5 m and 80 degrees.
struct Circle {
  std::vector<Eigen::Vector2d> landmarks;
  std::vector<Pose2> poses;
  Eigen::Vector2d p_robot_camera{0.15, -0.05};

  Circle() {
    for (int i = 0; i < 14; ++i) {
      const double angle = 2.0 * kPi * i / 14.0;
      const double radius = i % 2 ? 4.5 : 1.4;
      landmarks.emplace_back(radius * std::sin(angle), kCircle_m - radius * std::cos(angle));
    }
    poses.push_back({});
    for (int i = 0; i < 240; ++i)
      poses.push_back(poses.back() *
                      Pose2{2.0 * kCircle_m * std::sin(kPi / 240.0), 0.0, 2.0 * kPi / 240.0});
  }
  RangeBearingStep step(std::size_t i, double noise, std::mt19937& random) const {
    std::normal_distribution<double> normal;
    RangeBearingStep step;
    step.stamp_s = 0.1 * static_cast<double>(i);
    step.field_of_view = radians(160.0);
    if (i > 0) {
      step.T_previous_robot = poses[i - 1].inverse() * poses[i];
      step.T_previous_robot.x += 0.01 * noise * normal(random);
      step.T_previous_robot.phi += 0.005 * noise * normal(random);
      step.covariance.diagonal() << 1e-4, 1e-6, 2.5e-5;
    }
    for (const Eigen::Vector2d& p_world : landmarks) {
      const Eigen::Vector2d p = transform(poses[i].inverse(), p_world) - p_robot_camera;
      const double bearing = std::atan2(p.y(), p.x());
      if (p.norm() > 5.0 || std::abs(bearing) > radians(80.0)) continue;
      Measurement measurement;
      measurement.kind = LandmarkKind::kDepthSlope;
      measurement.p_robot_camera = p_robot_camera;
      measurement.z.resize(2);
      measurement.z << bearing + 0.005 * noise * normal(random),
          p.norm() + 0.02 * noise * normal(random);
      measurement.R = Eigen::Vector2d(2.5e-5, 4e-4).asDiagonal();
      step.measurements.push_back(measurement);
    }
    return step;
  }
};

TEST(RangeBearingFilter, ReproducesTheMapFromPerfectMeasurements) {
  const Circle circle;
  for (const char* update : {"naive", "davison"}) {
    KfSlamOptions options;
    options.update = update;
    RangeBearingFilter filter(options);
    std::mt19937 random(1);
    Pose2 last;
    for (std::size_t i = 0; i < circle.poses.size(); ++i)
      last = filter.step(circle.step(i, 0.0, random));
    const Pose2 error = circle.poses.back().inverse() * last;
    EXPECT_LT(error.translation().norm(), 0.01) << update;
    EXPECT_LT(std::abs(error.phi), radians(0.3)) << update;
    const LandmarkMap map = filter.landmarks();
    ASSERT_EQ(circle.landmarks.size(), map.size()) << update;
    for (const LandmarkRecord& record : map) {
      EXPECT_EQ(LandmarkKind::kDepthSlope, record.kind);
      EXPECT_GT(record.observations, 5);
      const bool right = std::any_of(circle.landmarks.begin(), circle.landmarks.end(),
                                     [&](auto& p) { return (p - record.p_world).norm() < 0.01; });
      EXPECT_TRUE(right) << update << " " << record.p_world.transpose();
    }
  }
}

TEST(RangeBearingFilter, DriftsLessThanItsMotionWhenEverythingIsNoisy) {
  const Circle circle;
  RangeBearingFilter filter({});
  std::mt19937 random(7);
  Pose2 slam;
  Pose2 reckoned;
  for (std::size_t i = 0; i < circle.poses.size(); ++i) {
    const RangeBearingStep step = circle.step(i, 1.0, random);
    reckoned = reckoned * step.T_previous_robot;
    slam = filter.step(step);
  }
  const auto error = [&](const Pose2& pose) {
    return (circle.poses.back().inverse() * pose).translation().norm();
  };
  EXPECT_LT(error(slam), 0.1);
  EXPECT_LT(error(slam), error(reckoned));
}

/// MRPT's filter stands still while it has no landmark; the motion must not be lost.
TEST(RangeBearingFilter, CarriesTheMotionBeforeTheFirstLandmark) {
  RangeBearingFilter filter({});
  RangeBearingStep step;
  step.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  step.T_previous_robot = {0.5, 0.0, 0.3};
  for (int i = 0; i < 3; ++i) filter.step(step);
  Measurement ahead;
  ahead.z.resize(2);
  ahead.z << 0.0, 2.0;
  ahead.R = 1e-6 * Eigen::Matrix2d::Identity();
  step.measurements = {ahead};
  const Pose2 robot = filter.step(step);
  const Pose2 once = step.T_previous_robot;
  EXPECT_TRUE(robot.vector().isApprox((once * once * once * once).vector(), 1e-6))
      << robot.vector().transpose();
  ASSERT_EQ(1u, filter.landmarks().size());
  EXPECT_LT((filter.landmarks()[0].p_world - transform(robot, {2.0, 0.0})).norm(), 1e-5);
}

}  // namespace
}  // namespace colonnade
