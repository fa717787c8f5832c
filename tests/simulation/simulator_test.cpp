// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/simulator.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/simulation/renderer.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

std::string bytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Simulator : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = whyNoRendering(); !why.empty()) GTEST_SKIP() << why;
    folder_ = std::filesystem::temp_directory_path() /
              ("colonnade_simulator_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
};

TEST_F(Simulator, logReadsBackWithTheTruthBesideIt) {
  const auto world = testing::roomWorld("camera rate_hz=5\n");
  const auto log = folder_ / "room.rawlog";
  const auto summary = simulate(world, log, {.seed = 3});
  const auto truth = readTum(folder_ / "room_ground_truth.tum");
  EXPECT_EQ(summary.frames, truth.size());
  EXPECT_NEAR(summary.path_length_m, 1.0, 0.02);

  RawlogSource source(log);
  std::size_t count = 0;
  Pose2 odometry;
  std::optional<Pose2> first_odometry;
  while (const auto frame = source.next()) {
    ASSERT_LT(count, truth.size());
    EXPECT_NEAR(frame->stamp_s, truth[count].stamp_s, 2e-6);
    EXPECT_EQ(frame->colour.size(), cv::Size(160, 120));
    EXPECT_EQ(frame->depth_m.size(), cv::Size(160, 120));
    EXPECT_GT(cv::countNonZero(frame->depth_m), 10000);
    EXPECT_NEAR(frame->camera.fx_px, world.camera.pinhole().fx_px, 1e-3);
    EXPECT_NEAR(frame->camera.cx_px, 79.5, 1e-3);
    EXPECT_TRUE(frame->T_robot_camera.isApprox(world.camera.T_robot_camera(), 1e-6));
    ASSERT_TRUE(frame->odometry);
    if (!first_odometry) first_odometry = frame->odometry->T_odom_robot;
    odometry = frame->odometry->T_odom_robot;
    ++count;
  }
  EXPECT_EQ(count, truth.size());
  EXPECT_FALSE(source.damage().any()) << source.damage().detail;
  // 1 m with 2.5 % scale error and 0.7 degrees drift, within noise.
  const Pose2 moved = first_odometry->inverse() * odometry;
  EXPECT_NEAR(moved.x, 1.025, 0.04);
  EXPECT_NEAR(moved.phi, radians(0.7), radians(1.8));
}

TEST_F(Simulator, truthKnowsWhatTheCameraSaw) {
  const auto log = folder_ / "room.rawlog";
  const auto summary = simulate(testing::roomWorld("camera rate_hz=5\n"), log, {});
  const auto landmarks = readLandmarksCsv(folder_ / "room_landmarks.csv");
  EXPECT_EQ(landmarks.size(), summary.landmarks);
  int ahead = 0, behind = 0;
  for (const auto& landmark : landmarks) {
    const bool upright = landmark.kind == LandmarkKind::kPillarEdge;
    // The front edges of the pilaster are in view all the time, the corners behind never.
    if (upright && std::abs(landmark.p_world.x() - 4.8) < 1e-6) {
      EXPECT_EQ(landmark.observations, static_cast<int>(summary.frames));
      ++ahead;
    }
    if (upright && landmark.p_world.x() < 0.0) {
      EXPECT_EQ(landmark.observations, 0);
      ++behind;
    }
  }
  EXPECT_EQ(ahead, 2);
  EXPECT_EQ(behind, 2);
  EXPECT_FALSE(cv::imread((folder_ / "room_floor.png").string()).empty());
  EXPECT_NE(bytesOf(folder_ / "room_floor.yaml").find("resolution: 0.05"), std::string::npos);
}

TEST_F(Simulator, sameSeedSameBytes) {
  const auto world = testing::roomWorld("camera rate_hz=3\n");
  simulate(world, folder_ / "a.rawlog", {.seed = 1});
  simulate(world, folder_ / "b.rawlog", {.seed = 1});
  simulate(world, folder_ / "c.rawlog", {.seed = 2});
  EXPECT_EQ(bytesOf(folder_ / "a.rawlog"), bytesOf(folder_ / "b.rawlog"));
  EXPECT_NE(bytesOf(folder_ / "a.rawlog"), bytesOf(folder_ / "c.rawlog"));
  EXPECT_EQ(bytesOf(folder_ / "a_landmarks.csv"), bytesOf(folder_ / "c_landmarks.csv"));
}

}  // namespace
}  // namespace colonnade
