// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/simulator.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/simulation/drive.hpp"
#include "colonnade/simulation/renderer.hpp"
#include "temporary_folder.hpp"
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
  }
  const testing::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
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

TEST_F(Simulator, sameBytesWithOneThreadAndWithTwo) {
  const auto world = testing::roomWorld("camera rate_hz=4 drop_fraction=0.2 stamp_jitter_s=0.02\n");
  simulate(world, folder_ / "one.rawlog", {.seed = 5, .pipeline = false});
  simulate(world, folder_ / "two.rawlog", {.seed = 5, .pipeline = true});
  for (const char* file : {".rawlog", "_columns.csv", "_landmarks.csv", "_ground_truth.tum"}) {
    EXPECT_FALSE(bytesOf(folder_ / ("one" + std::string(file))).empty()) << file;
    EXPECT_EQ(bytesOf(folder_ / ("one" + std::string(file))),
              bytesOf(folder_ / ("two" + std::string(file))))
        << file;
  }
}

TEST_F(Simulator, droppedFramesAndJitterKeepTruthAtTheStamps) {
  const std::string route = "drive 3 0 speed_m_per_s=0.5\nwait 1\n";
  const auto world = testing::roomWorld(route +
                                        "camera rate_hz=5 drop_fraction=0.3 stamp_jitter_s=0.02\n"
                                        "odometry scale=0 turn_bias_deg_per_m=0 turn_scale=0\n"
                                        "odometry forward_noise_m=0 sideways_noise_m=0\n"
                                        "odometry turn_noise_deg_per_m=0\n");
  const auto log = folder_ / "late.rawlog";
  const auto summary = simulate(world, log, {.seed = 3});
  const auto truth = readTum(folder_ / "late_ground_truth.tum");
  ASSERT_EQ(summary.frames, truth.size());
  const double planned = 1.0 + 5.0 * driveDuration(world.route);
  EXPECT_LT(static_cast<double>(truth.size()), 0.85 * planned);
  EXPECT_GT(static_cast<double>(truth.size()), 0.5 * planned);

  std::vector<double> times;
  bool off_beat = false;
  for (const auto& pose : truth) {
    times.push_back(pose.stamp_s - truth.front().stamp_s);
    const double beat = 5.0 * times.back();
    off_beat = off_beat || std::abs(beat - std::round(beat)) > 0.02;
  }
  EXPECT_TRUE(off_beat);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  const auto expected = posesAt(world.route, times);
  RawlogSource source(log);
  std::optional<Pose2> first_odometry;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(truth[i].T_world_body.translation().x(), expected[i].x, 1e-5);
    const auto frame = source.next();
    ASSERT_TRUE(frame && frame->odometry);
    EXPECT_NEAR(frame->stamp_s, truth[i].stamp_s, 2e-6);
    // Perfect wheels: the motion of a pair spans the frames that were dropped before it.
    if (!first_odometry) first_odometry = frame->odometry->T_odom_robot;
    const Pose2 moved = first_odometry->inverse() * frame->odometry->T_odom_robot;
    EXPECT_NEAR(moved.x, expected[i].x, 1e-5);
  }
}

TEST_F(Simulator, secondCameraIsLoggedBesideTheFirst) {
  const auto world = testing::roomWorld(
      "camera rate_hz=4\nmono rate_hz=2 width_px=200 height_px=100 yaw_deg=90 height_m=1.2\n");
  const auto log = folder_ / "two.rawlog";
  const auto summary = simulate(world, log, {.seed = 3});
  std::size_t rgbd = 0, mono = 0;
  RawlogSource first(log);
  while (const auto frame = first.next()) {
    EXPECT_EQ(frame->colour.size(), cv::Size(160, 120));
    ++rgbd;
  }
  SourceOptions options;
  options.sensor_label = "MONO";
  RawlogSource second(log, options);
  while (const auto frame = second.next()) {
    EXPECT_EQ(frame->colour.size(), cv::Size(200, 100));
    EXPECT_TRUE(frame->depth_m.empty());
    EXPECT_TRUE(frame->T_robot_camera.isApprox(world.mono.T_robot_camera(), 1e-6));
    // It looks to the left, where the room's wall is.
    EXPECT_GT((frame->T_robot_camera.linear() * Eigen::Vector3d::UnitZ()).y(), 0.99);
    ++mono;
  }
  EXPECT_EQ(rgbd, summary.frames);
  EXPECT_EQ(mono, (summary.frames + 1) / 2);
}

TEST_F(Simulator, lightOfTheScheduleReachesTheLog) {
  const auto world = testing::roomWorld(
      "camera rate_hz=4\ncolour exposure_noise=0\nlight at_m=0.3 level=1\nlight at_m=0.6 "
      "level=0.4\n");
  const auto log = folder_ / "dusk.rawlog";
  simulate(world, log, {.seed = 3});
  RawlogSource source(log);
  std::vector<double> means;
  while (const auto frame = source.next()) means.push_back(cv::mean(frame->gray)[0]);
  EXPECT_NEAR(means.back() / means.front(), 0.4, 0.06);
  EXPECT_GT(means[1] / means.front(), 0.95);
}

}  // namespace
}  // namespace colonnade
