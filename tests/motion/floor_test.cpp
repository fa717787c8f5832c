// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <memory>

#include "colonnade/motion/motion_estimator.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

/// A camera without depth on wheels that read ways too long.
class CameraWithoutDepth : public ::testing::Test {
 protected:
  struct Drive {
    Pose2 T_first_last;
    MotionIncrement last;
    double widest_along = 0.0;  ///< largest variance of a step
  };
  Drive drive(const Pose2& true_step, int steps) {
    MotionEstimator estimator(options_, std::make_shared<CameraTracker>(options_));
    Drive drive;
    Pose2 T_world_robot;
    Pose2 T_odom_robot;
    for (int i = 0; i <= steps; ++i) {
      const auto T_world_camera =
          cameraInWorld(T_world_robot.x, T_world_robot.y, 1.1, T_world_robot.phi, radians(20.0));
      Frame frame = scene_.render(static_cast<std::size_t>(i), 0.1 * i, T_world_camera);
      frame.depth_m.release();
      frame.T_robot_camera = mountingOf(T_world_camera);
      if (wheels_ && (gaps_ == 0 || i % gaps_ != 1))
        frame.odometry = OdometryReading{T_odom_robot, wheel_covariance_};
      drive.last = estimator.increment(frame);
      drive.T_first_last = drive.T_first_last * drive.last.T_previous_robot;
      drive.widest_along = std::max(drive.widest_along, drive.last.covariance(0, 0));
      T_world_robot = T_world_robot * true_step;
      const double slip = i >= slip_from_ && i < slip_to_ ? 2.0 : 1.0;
      T_odom_robot = T_odom_robot * Pose2{1.05 * slip * true_step.x, true_step.y, true_step.phi};
    }
    return drive;
  }
  MotionOptions options_;
  Scene scene_ = Scene::corridor(true, false);
  bool wheels_ = true;
  int gaps_ = 0;  ///< every so many readings of the wheels one is missing
  int slip_from_ = 0, slip_to_ = 0;
  std::optional<Eigen::Matrix3d> wheel_covariance_;  ///< of each step, if the log states it
};

TEST_F(CameraWithoutDepth, MeasuresTheWayByTheFloor) {
  // The first 0.2 m are the wheels', until the floor has agreed with them that long.
  const Drive driven = drive({0.08, 0.0, 0.0}, 15);
  EXPECT_EQ(driven.last.source, MotionSource::kOdometryVisual);
  EXPECT_NEAR(driven.T_first_last.x, 1.2, 0.022);  // the wheels alone: 1.26
  EXPECT_NEAR(driven.T_first_last.y, 0.0, 0.012);
  EXPECT_NEAR(driven.T_first_last.phi, 0.0, radians(0.5));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(driven.last.covariance);
  EXPECT_GT(eigen.eigenvalues()(0), 0.0);
}

TEST_F(CameraWithoutDepth, NeedsNoWheels) {
  wheels_ = false;
  const Drive driven = drive({0.06, 0.0, radians(0.4)}, 15);
  Pose2 truth;
  for (int i = 0; i < 15; ++i) truth = truth * Pose2{0.06, 0.0, radians(0.4)};
  EXPECT_EQ(driven.last.source, MotionSource::kFloor);
  EXPECT_NEAR(driven.T_first_last.x, truth.x, 0.02);
  EXPECT_NEAR(driven.T_first_last.y, truth.y, 0.02);
  EXPECT_NEAR(driven.T_first_last.phi, truth.phi, radians(1.0));
}

TEST_F(CameraWithoutDepth, LeavesABareFloorToTheWheels) {
  scene_.textured = false;
  const Drive driven = drive({0.08, 0.0, 0.0}, 4);
  EXPECT_EQ(driven.last.source, MotionSource::kOdometry);
  EXPECT_NEAR(driven.T_first_last.x, 4 * 1.05 * 0.08, 1e-9);
}

/// Without depth on a floor that shows hardly anything of itself, with wheels so uncertain that no
/// single step contradicts them.
class OnAPolishedFloor : public CameraWithoutDepth {
 protected:
  OnAPolishedFloor() {
    scene_ = Scene::corridor(true, true);
    scene_.walls.back().offset = 6.0;
    scene_.gloss = 0.85;
    wheel_covariance_ = Eigen::Vector3d(0.01, 0.01, radians(0.3)).cwiseAbs2().asDiagonal();
  }
};

TEST_F(OnAPolishedFloor, WhatItMirrorsIsNotFollowed) {
  const Drive driven = drive({0.05, 0.0, 0.0}, 30);
  EXPECT_NEAR(driven.T_first_last.x, 1.5, 0.1);  // the wheels alone: 1.575
}

TEST_F(OnAPolishedFloor, NorAfterGapsInTheOdometry) {
  for (const int gaps : {4, 7}) {
    gaps_ = gaps;
    EXPECT_NEAR(drive({0.05, 0.0, 0.0}, 30).T_first_last.x, 1.5, 0.12);
  }
}

TEST_F(CameraWithoutDepth, WheelsThatSlipAreDoubtedAndTheFloorIsFollowedAgainLater) {
  const double usual = drive({0.08, 0.0, 0.0}, 22).widest_along;
  slip_from_ = 12;
  slip_to_ = 14;
  const Drive slipped = drive({0.08, 0.0, 0.0}, 22);
  EXPECT_GT(slipped.widest_along, 3.0 * usual);
  EXPECT_EQ(slipped.last.source, MotionSource::kOdometryVisual);
}

TEST_F(CameraWithoutDepth, LeavesSharpTurnsToTheWheels) {
  const Drive driven = drive({0.05, 0.0, radians(5.0)}, 4);
  EXPECT_EQ(driven.last.source, MotionSource::kOdometry);
  EXPECT_NEAR(driven.T_first_last.phi, 4 * radians(5.0), 1e-9);
}

TEST_F(CameraWithoutDepth, StandsStillWhenTheRobotDoes) {
  const Drive driven = drive({}, 10);
  EXPECT_LT(driven.T_first_last.translation().norm(), 0.001);
}

}  // namespace
}  // namespace colonnade
