// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "camera_path.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/baselines/baseline.hpp"
#include "patterned_room.hpp"

namespace colonnade {
namespace {

TEST(DeadReckoning, IsTheOdometryOfTheLogFromItsFirstFrameOn) {
  const auto baseline = makeBaseline("dead-reckoning", {});
  const std::vector<Pose2> poses = testing::bend(40);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Frame frame;
    frame.index = i;
    frame.odometry = OdometryReading{poses[i], std::nullopt};
    const BaselineStep step = baseline->step(frame);
    const Pose2 expected = poses.front().inverse() * poses[i];
    EXPECT_TRUE(step.lost.empty());
    EXPECT_EQ(expected.vector(), step.T_world_robot.vector());
  }
}

TEST(DeadReckoning, KeepsItsPoseWhereTheLogHasAGap) {
  const auto baseline = makeBaseline("dead-reckoning", {});
  Frame frame;
  frame.odometry = OdometryReading{{1.0, 2.0, 0.5}, std::nullopt};
  baseline->step(frame);
  frame.odometry = OdometryReading{{2.0, 2.0, 0.5}, std::nullopt};
  const Pose2 before = baseline->step(frame).T_world_robot;
  frame.odometry.reset();
  const BaselineStep gap = baseline->step(frame);
  EXPECT_FALSE(gap.lost.empty());
  EXPECT_EQ(before.vector(), gap.T_world_robot.vector());
}

TEST(DeadReckoning, SaysThatALogHoldsNoOdometry) {
  EXPECT_THROW(makeBaseline("dead-reckoning", {})->step(Frame{}), Error);
}

TEST(Baselines, RefuseAnUnknownName) {
  try {
    makeBaseline("orb-slam", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(ExitCode::kUsage, error.code());
    EXPECT_NE(std::string::npos, std::string(error.what()).find("kinect-3d-slam"));
  }
}

/// A tilted camera beside the robot's centre: its path in space gives the robot's path back.
TEST(CameraPath, GivesTheRobotUnderACameraThatHangsAnyhow) {
  Eigen::Isometry3d T_robot_camera = testing::PatternedRoom::mounting();
  T_robot_camera.prerotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  const CameraPath path(T_robot_camera);
  for (const Pose2& pose : testing::bend(20)) {
    const Eigen::Isometry3d T_first_camera =
        T_robot_camera.inverse() * pose.toIsometry3() * T_robot_camera;
    EXPECT_TRUE(path.robot(T_first_camera).vector().isApprox(pose.vector(), 1e-9));
  }
}

}  // namespace
}  // namespace colonnade
