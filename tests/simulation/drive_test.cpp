// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

RouteStep driveTo(double x, double y, double radius_m = 0.0, double speed = 0.8) {
  RouteStep step;
  step.to = {x, y};
  step.radius_m = radius_m;
  step.speed_m_per_s = speed;
  return step;
}

double nearest(const std::vector<Pose2>& poses, const Eigen::Vector2d& p) {
  double distance = 1e9;
  for (const auto& pose : poses) distance = std::min(distance, (pose.translation() - p).norm());
  return distance;
}

TEST(Drive, withoutArcsItHitsEveryWaypoint) {
  const Route route{{1, 1, 0}, {driveTo(4, 1), driveTo(4, 4), driveTo(0, 2)}};
  const auto poses = driveRoute(route, 20.0);
  EXPECT_EQ(poses.front().vector(), Eigen::Vector3d(1, 1, 0));
  for (const auto& step : route.steps) EXPECT_LT(nearest(poses, step.to), 1e-2);
  EXPECT_LT((poses.back().translation() - Eigen::Vector2d(0, 2)).norm(), 1e-2);
}

TEST(Drive, anArcCutsACornerByItsRadius) {
  const Route route{{0, 0, 0}, {driveTo(5, 0, 1.0), driveTo(5, 5)}};
  const auto poses = driveRoute(route, 50.0);
  // A right angle rounded with radius r passes its corner at r (sqrt(2) - 1).
  EXPECT_NEAR(nearest(poses, {5, 0}), std::sqrt(2.0) - 1.0, 0.01);
  EXPECT_NEAR(poses.back().phi, radians(90.0), 1e-6);
}

TEST(Drive, respectsSpeedAccelerationAndNonholonomy) {
  const double rate = 20.0;
  const Route route{{0, 0, 0}, {driveTo(5, 0, 0.8, 0.9), driveTo(5, 5, 0.8, 0.9), driveTo(0, 5)}};
  const auto poses = driveRoute(route, rate);
  double before = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose2 moved = poses[i - 1].inverse() * poses[i];
    const double speed = moved.translation().norm() * rate;
    EXPECT_LE(speed, 0.9 + 1e-9);
    EXPECT_LE(std::abs(speed - before), 0.5 / rate + 0.01) << "frame " << i;
    EXPECT_LE(std::abs(moved.phi) * rate, radians(60.0) + 1e-6);
    // Wheels do not slip sideways.
    if (speed > 0.05 && std::abs(moved.phi) < 1e-9) {
      EXPECT_NEAR(moved.y, 0.0, 1e-9);
    }
    before = speed;
  }
}

TEST(Drive, turnsOnTheSpotAndWaits) {
  RouteStep turn;
  turn.kind = RouteStep::Kind::kTurn;
  turn.angle = radians(-180.0);
  turn.turn_rate = radians(90.0);
  RouteStep wait;
  wait.kind = RouteStep::Kind::kWait;
  wait.duration_s = 1.0;
  const auto poses = driveRoute({{0, 0, 0}, {turn, wait}}, 10.0);
  EXPECT_NEAR(static_cast<double>(poses.size()), 31.0, 1.0);  // 2 s, 1 s and the start
  EXPECT_NEAR(std::abs(poses.back().phi), kPi, 1e-6);
  EXPECT_EQ(poses.back().translation(), Eigen::Vector2d(0, 0));
}

TEST(Drive, refusesArcsThatDoNotFit) {
  EXPECT_THROW(driveRoute({{0, 0, 0}, {driveTo(1, 0, 2.0), driveTo(1, 5)}}, 10.0), Error);
  EXPECT_THROW(driveRoute({{0, 0, 0}, {driveTo(0, 0)}}, 10.0), Error);
}

}  // namespace
}  // namespace colonnade
