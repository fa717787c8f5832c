// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>

#include "camera_by_wheels.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

/// A camera on wheels that moves by `true_step` in each frame, while the wheels read `read_step`.
class BothOdometries : public ::testing::Test {
 protected:
  enum class View { kScene, kDark, kOpenEnd, kMovingLight, kWalker, kWalkerInRoom };
  MotionIncrement drive(const Pose2& true_step, const Pose2& read_step,
                        const Eigen::Vector3d& wheel_sigmas, View view = View::kScene) {
    MotionEstimator estimator(options_, std::make_shared<CameraTracker>(options_));
    const bool closed = view != View::kOpenEnd && view != View::kWalker;
    Scene scene = Scene::corridor(true, closed);
    if (view == View::kWalker) scene.person = testing::Person{{1.8, 0.3, 0.0}};
    if (view == View::kWalkerInRoom) scene.person = testing::Person{{1.4, 0.3, 0.0}, 0.6};
    // Only the floor and the wall ahead: nothing but brightness tells the place across.
    if (view == View::kMovingLight) scene.walls = {scene.walls.front(), scene.walls.back()};
    MotionIncrement motion;
    Pose2 T_world_robot;
    Pose2 T_odom_robot;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto T_world_camera =
          cameraInWorld(T_world_robot.x, T_world_robot.y, 1.1, T_world_robot.phi, radians(12.0));
      Frame frame = scene.render(i, period_s_ * static_cast<double>(i), T_world_camera);
      frame.T_robot_camera = mountingOf(T_world_camera);
      frame.odometry =
          OdometryReading{T_odom_robot, Eigen::Matrix3d(wheel_sigmas.cwiseAbs2().asDiagonal())};
      if (view == View::kDark) {
        frame.gray.setTo(0);
        frame.depth_m.setTo(0.0f);
      }
      if (view == View::kMovingLight) scene.pattern_shift.y() -= 0.1;
      if (scene.person) scene.person->p_feet.x() += 0.8 * true_step.x;
      motion = estimator.increment(frame);
      T_world_robot = T_world_robot * true_step;
      T_odom_robot = T_odom_robot * read_step;
    }
    return motion;
  }
  MotionOptions options_;
  double period_s_ = 0.1;
  const Pose2 step_{0.06, 0.0, radians(1.0)};
  const Eigen::Vector3d coarse_{0.02, 0.02, radians(2.0)};
};

TEST_F(BothOdometries, AreSurerTogetherThanEither) {
  const auto fused = drive(step_, step_, {0.002, 0.002, radians(0.2)});
  options_.source = "visual";
  const auto visual = drive(step_, step_, {0.002, 0.002, radians(0.2)});
  options_.source = "odometry";
  const auto wheels = drive(step_, step_, {0.002, 0.002, radians(0.2)});
  EXPECT_EQ(fused.source, MotionSource::kOdometryVisual);
  EXPECT_EQ(wheels.source, MotionSource::kOdometry);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(fused.covariance(i, i), std::min(visual.covariance(i, i), wheels.covariance(i, i)));
}

TEST_F(BothOdometries, CoarseWheelsAreCorrectedByTheCamera) {
  const auto motion = drive(step_, {0.07, 0.01, radians(2.0)}, coarse_);
  EXPECT_NEAR(motion.T_previous_robot.x, step_.x, 0.004);
  EXPECT_NEAR(motion.T_previous_robot.y, step_.y, 0.004);
  EXPECT_NEAR(motion.T_previous_robot.phi, step_.phi, radians(0.2));
}

TEST_F(BothOdometries, ABlindCameraLeavesTheWheelsAsTheyAre) {
  const Pose2 read{0.07, 0.01, radians(2.0)};
  const auto motion = drive(step_, read, coarse_, View::kDark);
  EXPECT_EQ(motion.source, MotionSource::kOdometry);
  EXPECT_LT((motion.T_previous_robot.vector() - read.vector()).norm(), 1e-12);
}

TEST_F(BothOdometries, LongStepsAreMeasuredFromWhereTheWheelsSay) {
  period_s_ = 0.5;
  for (const Pose2 step : {Pose2{0.48, 0.0, 0.0}, Pose2{0.1, 0.02, radians(30.0)}}) {
    const Pose2 read{1.03 * step.x, step.y + 0.01, 1.03 * step.phi + radians(0.5)};
    const auto motion = drive(step, read, coarse_);
    EXPECT_EQ(motion.source, MotionSource::kOdometryVisual);
    EXPECT_NEAR(motion.T_previous_robot.x, step.x, 0.008);
    EXPECT_NEAR(motion.T_previous_robot.y, step.y, 0.008);
    EXPECT_NEAR(motion.T_previous_robot.phi, step.phi, radians(0.4));
  }
}

TEST_F(BothOdometries, StepsBeyondReachAreLeftToTheWheels) {
  period_s_ = 0.5;
  options_.visual_reach_m = 0.3;
  const Pose2 read{0.5, 0.01, 0.0};
  const auto motion = drive({0.48, 0.0, 0.0}, read, coarse_);
  EXPECT_EQ(motion.source, MotionSource::kOdometry);
  EXPECT_LT((motion.T_previous_robot.vector() - read.vector()).norm(), 1e-12);
}

TEST_F(BothOdometries, WheelsThatSlipWhereOnlyBrightnessTellsAreDoubted) {
  // An open corridor: surfaces fix heading and the place across, only brightness the way.
  const Eigen::Vector3d sigmas(0.004, 0.004, radians(0.2));
  const auto motion = drive({0.02, 0.0, 0.0}, {0.06, 0.0, 0.0}, sigmas, View::kOpenEnd);
  EXPECT_GT(std::sqrt(motion.covariance(0, 0)), 1.7 * sigmas.x());
}

TEST_F(BothOdometries, WhereBrightnessContradictsTheWheelsSurfacesCount) {
  const Pose2 step{0.06, 0.0, radians(6.0)};
  const Pose2 read{0.06, 0.0, radians(7.0)};
  const auto motion = drive(step, read, {0.01, 0.01, radians(1.0)}, View::kMovingLight);
  EXPECT_EQ(motion.source, MotionSource::kOdometryVisual);
  EXPECT_NEAR(motion.T_previous_robot.phi, step.phi, radians(0.4));
  EXPECT_LT(std::sqrt(motion.covariance(2, 2)), radians(0.8));
}

TEST_F(BothOdometries, SomeoneWhoWalksAlongDoesNotCarryTheRobot) {
  // In the open corridor only his surfaces tell the way.
  const Eigen::Vector3d sigmas(0.01, 0.01, radians(1.0));
  const auto motion = drive({0.09, 0.0, 0.0}, {0.094, 0.0, 0.0}, sigmas, View::kWalker);
  EXPECT_EQ(motion.source, MotionSource::kOdometryVisual);
  EXPECT_NEAR(motion.T_previous_robot.x, 0.09, 0.003);
  EXPECT_LT(std::sqrt(motion.covariance(0, 0)), 0.5 * sigmas.x());
}

TEST_F(BothOdometries, WithoutWheelsTheSceneItselfTellsWhoWalks) {
  options_.source = "visual";
  const auto motion = drive({0.04, 0.0, 0.0}, {}, coarse_, View::kWalkerInRoom);
  EXPECT_NEAR(motion.T_previous_robot.x, 0.04, 0.001);
}

TEST_F(BothOdometries, AConflictKeepsTheWheelsWithMoreDoubt) {
  // The whole view moves by what no wheel feels, or an alignment went wrong.
  const Eigen::Vector3d sigmas(0.002, 0.002, radians(0.2));
  const auto motion = drive(step_, {0.0, 0.0, 0.0}, sigmas);
  EXPECT_EQ(motion.source, MotionSource::kOdometry);
  EXPECT_LT(motion.T_previous_robot.vector().norm(), 1e-12);
  EXPECT_GT(motion.covariance(0, 0), 2.0 * sigmas.x() * sigmas.x());
  EXPECT_LT(motion.covariance(0, 0), 10.0 * sigmas.x() * sigmas.x());
}

TEST(CameraByWheels, CovarianceFollowsTheIncrement) {
  // Two mountings, off the robot's centre and rolled, and a turn between.
  Eigen::Isometry3d before = cameraInWorld(0.2, -0.1, 1.1, radians(20.0), radians(12.0), 0.05);
  Eigen::Isometry3d now = cameraInWorld(0.25, -0.05, 1.12, radians(25.0), radians(9.0), -0.03);
  const Pose2 step{0.3, -0.05, radians(30.0)};
  OdometryReading from{{1.0, 2.0, 0.7}, std::nullopt};
  const auto moved = [&](const Eigen::Vector3d& error) {
    const Eigen::Vector3d disturbed = step.vector() + error;
    OdometryReading to{from.T_odom_robot * Pose2{disturbed.x(), disturbed.y(), disturbed.z()},
                       Eigen::Matrix3d(Eigen::Vector3d(4e-4, 1e-4, 9e-4).asDiagonal())};
    return cameraByWheels(from, to, before, now, {});
  };
  const CameraByWheels there = moved(Eigen::Vector3d::Zero());
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 6, 3> J;
  for (int i = 0; i < 3; ++i)
    J.col(i) = logSe3(there.T_previous_camera.inverse() *
                      moved(kStep * Eigen::Vector3d::Unit(i)).T_previous_camera) /
               kStep;
  const Matrix6 of_wheels = J * Eigen::Vector3d(4e-4, 1e-4, 9e-4).asDiagonal() * J.transpose();
  // What remains is sway and nod: of the robot, up and about its two level axes, and sideways.
  const Matrix6 rest = there.covariance - of_wheels;
  const Matrix6 Ad = adjoint(now);
  const Matrix6 in_robot = Ad * rest * Ad.transpose();
  EXPECT_LT((in_robot - Matrix6(in_robot.diagonal().asDiagonal())).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(in_robot(5, 5), 0.0, 1e-9);
  EXPECT_GT(in_robot(3, 3), 1e-6);
}

}  // namespace
}  // namespace colonnade
