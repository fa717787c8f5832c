// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/levelled_scan.hpp"

#include <gtest/gtest.h>

#include <random>

#include "synthetic_hall.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;

struct Mounting {
  const char* name;
  double pitch_down_deg;
  double roll_deg;
  double yaw_deg;
};

class LevelledScanOfARoom : public ::testing::TestWithParam<Mounting> {};

/// What the beam should read: the nearest wall anywhere within the beam's width, give or take.
TEST_P(LevelledScanOfARoom, EqualsTheDistancesToTheWalls) {
  const auto walls = corridor();
  const auto T_robot_camera =
      mountCamera(0.12, 0.95, radians(GetParam().pitch_down_deg), radians(GetParam().roll_deg),
                  radians(GetParam().yaw_deg));
  const Pose2 T_world_robot{0.4, 0.2, 0.3};
  ScanCutter cutter({});
  const auto scan = cutter.cut(renderFrame(walls, T_world_robot, T_robot_camera, 0.0));
  ASSERT_TRUE(scan);
  EXPECT_TRUE(scan->p_robot_camera().isApprox(Eigen::Vector2d(0.12, 0.0), 1e-12));
  EXPECT_NEAR(scan->T_robot_scan.phi, radians(GetParam().yaw_deg), 1e-9);
  const Pose2 T_world_scan = T_world_robot * scan->T_robot_scan;
  int compared = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < scan->size(); ++i) {
    const auto expected = [&](double offset) {
      const double angle = T_world_scan.phi + scan->angle(i) + offset * scan->step;
      return distanceTo(walls, T_world_scan.translation(), {std::cos(angle), std::sin(angle)});
    };
    const double left = expected(0.5);
    const double right = expected(-0.5);
    if (!scan->valid(i) || std::abs(left - right) > 0.2) continue;  // edges of pillars
    ++compared;
    const double middle = expected(0.0);
    if (std::abs(scan->ranges_m[i] - middle) > 0.01 + 0.6 * std::abs(left - right)) ++wrong;
  }
  EXPECT_GT(compared, 70);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Mountings, LevelledScanOfARoom,
                         ::testing::Values(Mounting{"Level", 0.0, 0.0, 0.0},
                                           Mounting{"Pitched", 12.0, 0.0, 0.0},
                                           Mounting{"PitchedAndRolled", 8.0, -5.0, 0.0},
                                           Mounting{"LookingAside", 5.0, 0.0, 25.0}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(LevelledScan, DoesNotTakeTheFloorForAnObstacle) {
  // A hall so large that the camera sees nothing but floor within range.
  ScanCutter cutter({});
  const auto scan = cutter.cut(
      renderFrame(rectangle({-50, -50}, {50, 50}), {}, mountCamera(0.0, 0.9, radians(20.0)), 0.0));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->validBeams(), 0U);
  for (std::size_t i = 0; i < scan->size(); ++i)
    if (std::abs(scan->angle(i)) < radians(28.0)) {
      EXPECT_GT(scan->free_m[i], 4.0F) << "beam " << i;
    }
}

TEST(LevelledScan, SeesTheFloorFreeOnlyUpToTheFirstGap) {
  auto frame =
      renderFrame(rectangle({-50, -50}, {50, 50}), {}, mountCamera(0.0, 0.9, radians(20.0)), 0.0);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      auto& depth = frame.depth_m.at<float>(v, u);
      if (depth > 2.0F && depth < 3.0F) depth = 0.0F;
    }
  ScanCutter cutter({});
  const auto scan = cutter.cut(frame);
  ASSERT_TRUE(scan);
  for (const float free_m : scan->free_m) EXPECT_LT(free_m, 2.6F);
}

TEST(LevelledScan, IsNotPulledNearerBySpecklesOrNoise) {
  auto frame =
      renderFrame(rectangle({-1.0, -3.0}, {3.0, 3.0}), {}, mountCamera(0.0, 0.8, 0.1), 0.0);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      auto& depth = frame.depth_m.at<float>(v, u);
      depth += noise(random);
      if (random() % 100 == 0) depth = 0.5F + 0.002F * static_cast<float>(random() % 1000);
      if (random() % 50 == 0) depth = std::numeric_limits<float>::quiet_NaN();
    }
  ScanCutter cutter({});
  const auto scan = cutter.cut(frame);
  ASSERT_TRUE(scan);
  for (std::size_t i = 0; i < scan->size(); ++i) {
    if (std::abs(scan->angle(i)) > radians(25.0)) continue;
    ASSERT_TRUE(scan->valid(i));
    EXPECT_NEAR(scan->ranges_m[i] * std::cos(scan->angle(i)), 3.0, 0.03) << "beam " << i;
  }
}

TEST(LevelledScan, FollowsATiltThatChangesFromFrameToFrame) {
  const auto walls = rectangle({-1.0, -3.0}, {3.0, 3.0});
  ScanCutter cutter({});
  for (const double pitch_deg : {0.0, 15.0, -5.0}) {
    const auto scan =
        cutter.cut(renderFrame(walls, {}, mountCamera(0.0, 0.8, radians(pitch_deg)), 0.0));
    ASSERT_TRUE(scan);
    EXPECT_NEAR(scan->ranges_m[scan->size() / 2], 3.0, 0.005) << pitch_deg;
  }
}

TEST(LevelledScan, TakesAnImageOfAnotherSize) {
  const auto walls = rectangle({-1.0, -3.0}, {3.0, 3.0});
  ScanCutter cutter({});
  auto frame = renderFrame(walls, {}, mountCamera(0.0, 0.8, 0.0), 0.0);
  ASSERT_TRUE(cutter.cut(frame));
  frame.depth_m = frame.depth_m(cv::Rect(0, 0, 100, 80)).clone();
  EXPECT_TRUE(cutter.cut(frame));
}

TEST(LevelledScan, NeedsDepthAndCalibration) {
  ScanCutter cutter({});
  EXPECT_FALSE(cutter.cut(Frame{}));
  auto frame = renderFrame(corridor(), {}, mountCamera(0.0, 0.8, 0.0), 0.0);
  frame.camera.fx_px = 0.0;
  EXPECT_FALSE(cutter.cut(frame));
}

TEST(LevelledScan, LeavesBeamsWithoutDepthInvalid) {
  auto frame = renderFrame(corridor(), {}, mountCamera(0.0, 0.8, 0.0), 0.0);
  frame.depth_m.setTo(0.0F);
  ScanCutter cutter({});
  const auto scan = cutter.cut(frame);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->validBeams(), 0U);
}

}  // namespace
}  // namespace colonnade
