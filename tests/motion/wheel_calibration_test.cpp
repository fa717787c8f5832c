// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "colonnade/base/angle.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "synthetic_scene.hpp"
#include "wheel_odometry.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

/// Wheels 3 % too large that drift by 1 degree a metre and turn 3 % too far.
Pose2 misread(const Pose2& step) {
  const double way_m = step.translation().norm();
  return {1.03 * step.x, 1.03 * step.y, 1.03 * step.phi + radians(1.0) * way_m};
}

class LearntWheels : public ::testing::Test {
 protected:
  MotionIncrement read(const Pose2& read_step) const {
    return odometryIncrement({Pose2{}, {}}, {read_step, {}}, options_);
  }
  MotionIncrement seen(const Pose2& step) {
    constexpr double kSigma_m = 0.002, kSigma = radians(0.1);
    std::normal_distribution<double> normal;
    MotionIncrement camera;
    camera.source = MotionSource::kPhotometricIcp;
    camera.T_previous_robot = {step.x + kSigma_m * normal(random_),
                               step.y + kSigma_m * normal(random_),
                               step.phi + kSigma * normal(random_)};
    camera.covariance.diagonal() << kSigma_m * kSigma_m, kSigma_m * kSigma_m, kSigma * kSigma;
    return camera;
  }
  /// Straight on and round corners, 0.08 m a frame.
  void drive(double way_m) {
    for (int i = 0; i * 0.08 < way_m; ++i) {
      const Pose2 step{0.08, 0.0, i % 25 < 10 ? radians(6.0) : 0.0};
      calibration_.learn(read(misread(step)), seen(step));
    }
  }
  Pose2 errorOf(const Pose2& step) const {
    return step.inverse() * calibration_.corrected(read(misread(step))).T_previous_robot;
  }

  MotionOptions options_;
  WheelCalibration calibration_{options_};
  std::mt19937_64 random_{3};
};

TEST_F(LearntWheels, AfterTenMetresMostOfWhatTheyGetWrongIsGone) {
  drive(10.0);
  const Pose2 straight = errorOf({1.0, 0.0, 0.0}), round = errorOf({0.0, 0.0, 1.0});
  EXPECT_LT(std::abs(straight.x), 0.009);            // of 0.03
  EXPECT_LT(std::abs(straight.phi), radians(0.35));  // of 1
  EXPECT_LT(std::abs(round.phi), 0.012);             // of 0.03
  drive(60.0);
  EXPECT_LT(std::abs(errorOf({1.0, 0.0, 0.0}).x), 0.006);
}

TEST_F(LearntWheels, CovariancesAndRestStayAsTheyWere) {
  drive(10.0);
  const MotionIncrement raw = read({0.1, 0.0, 0.05});
  EXPECT_EQ(calibration_.corrected(raw).covariance, raw.covariance);
  const MotionIncrement still = calibration_.corrected(read({}));
  EXPECT_EQ(still.T_previous_robot.vector(), Eigen::Vector3d::Zero());
}

TEST_F(LearntWheels, ASlipTeachesNothing) {
  drive(3.0);
  const Pose2 before = errorOf({1.0, 0.0, 0.5});
  calibration_.learn(read({0.3, 0.0, 0.0}), seen({0.08, 0.0, 0.0}));
  EXPECT_EQ(errorOf({1.0, 0.0, 0.5}).vector(), before.vector());
}

TEST_F(LearntWheels, NothingIsLearntBeyondWhatIsPlausible) {
  for (int i = 0; i < 2000; ++i)  // a mirror that shows nine tenths of each way
    calibration_.learn(read({0.08, 0.0, 0.0}), seen({0.072, 0.0, 0.0}));
  const double left =
      calibration_.corrected(read({1.0, 0.0, 0.0})).T_previous_robot.translation().norm();
  EXPECT_GT(left, 1.0 / (1.0 + 3.0 * options_.odometry_along) - 1e-9);
}

TEST_F(LearntWheels, RestTeachesNothing) {
  for (int i = 0; i < 600; ++i) calibration_.learn(read({}), seen({}));
  const Pose2 read_back = calibration_.corrected(read({1.0, 0.0, 1.0})).T_previous_robot;
  EXPECT_NEAR(read_back.translation().norm(), 1.0, 0.005);
  EXPECT_NEAR(read_back.phi, 1.0, 0.01);
}

TEST_F(LearntWheels, RightWheelsStayRightStraightOnAndRoundCorners) {
  for (const int corner_frames : {0, 6}) {
    WheelCalibration calibration(options_);
    for (int i = 0; i < 2000; ++i) {
      const Pose2 step{0.03, 0.0, i % 200 < corner_frames ? radians(15.0) : 0.0};
      calibration.learn(read(step), seen(step));
    }
    const Pose2 read_back = calibration.corrected(read({1.0, 0.0, 1.0})).T_previous_robot;
    EXPECT_NEAR(read_back.translation().norm(), 1.0, 0.006) << corner_frames;
    EXPECT_NEAR(read_back.phi, 1.0, 0.012) << corner_frames;
  }
}

TEST_F(LearntWheels, BackwardsTheHeadingDriftsTheOtherWay) {
  drive(10.0);
  MotionIncrement back = read({-1.0, 0.0, -radians(1.0)});
  EXPECT_LT(std::abs(calibration_.corrected(back).T_previous_robot.phi), radians(0.35));
}

TEST_F(LearntWheels, UnsureOptionsDoNotTurnTheMotionRound) {
  options_.odometry_along = 0.5;
  options_.odometry_turn = radians(40.0);
  WheelCalibration calibration(options_);
  for (int i = 0; i < 500; ++i) calibration.learn(read({0.01, 0.0, 0.01}), seen({0.05, 0.0, 0.05}));
  const Pose2 read_back = calibration.corrected(read({1.0, 0.0, 1.0})).T_previous_robot;
  EXPECT_GT(read_back.translation().norm(), 0.8);
  EXPECT_LT(read_back.translation().norm(), 1.26);
}

TEST_F(LearntWheels, TheSwitchLeavesThemAsRead) {
  options_.calibrate_wheels = false;
  WheelCalibration calibration(options_);
  const Pose2 step{0.08, 0.0, 0.0};
  for (int i = 0; i < 200; ++i) calibration.learn(read(misread(step)), seen(step));
  EXPECT_EQ(calibration.corrected(read(step)).T_previous_robot.vector(),
            read(step).T_previous_robot.vector());
}

/// In the light wheels and camera are compared; then the light goes out.
TEST(WheelsAndCamera, WhatTheCameraTaughtTheWheelsHoldsInTheDark) {
  const MotionOptions options;
  MotionEstimator estimator(options, std::make_shared<CameraTracker>(options));
  const Scene scene = Scene::corridor(true, true);
  Pose2 T_world_robot{-3.0, 0.0, 0.0}, T_odom_robot, T_dark;
  const Pose2 step{0.05, 0.0, 0.0};
  for (std::size_t i = 0; i < 60; ++i) {
    const auto T_world_camera =
        cameraInWorld(T_world_robot.x, 0.0, 1.1, T_world_robot.phi, radians(12.0));
    Frame frame = scene.render(i, 0.1 * static_cast<double>(i), T_world_camera);
    frame.T_robot_camera = mountingOf(T_world_camera);
    frame.odometry = OdometryReading{T_odom_robot, std::nullopt};
    if (i > 40) {
      frame.gray.setTo(0);
      frame.depth_m.setTo(0.0f);
    }
    const MotionIncrement motion = estimator.increment(frame);
    if (i > 41) T_dark = T_dark * motion.T_previous_robot;
    T_world_robot = T_world_robot * step;
    T_odom_robot = T_odom_robot * misread(step);
  }
  const double way_m = 18 * step.x;
  EXPECT_NEAR(T_dark.x, way_m, 0.018 * way_m);  // by wheels alone 3 % off
  EXPECT_LT(std::abs(T_dark.phi), 0.5 * radians(1.0) * way_m);
}

}  // namespace
}  // namespace colonnade
