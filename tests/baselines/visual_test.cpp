// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "colonnade/baselines/baseline.hpp"
#include "patterned_room.hpp"

namespace colonnade {
namespace {

using testing::bend;
using testing::PatternedRoom;

/// How far the last pose is off after a known path, relative to the first frame.
Pose2 errorAfter(Baseline& baseline, const std::vector<Pose2>& poses, int* lost = nullptr) {
  const PatternedRoom room;
  Pose2 last;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BaselineStep step = baseline.step(room.render(i, poses[i]));
    if (lost && !step.lost.empty()) ++*lost;
    last = step.T_world_robot;
  }
  return (poses.front().inverse() * poses.back()).inverse() * last;
}

TEST(KinectSlam, FollowsAKnownWay) {
  const auto baseline = makeBaseline("kinect-3d-slam", {});
  int lost = 0;
  const Pose2 error = errorAfter(*baseline, bend(25), &lost);
  EXPECT_EQ(0, lost);
  EXPECT_LT(error.translation().norm(), 0.05) << error.vector().transpose();
  EXPECT_LT(std::abs(error.phi), radians(1.5));
  EXPECT_GE(baseline->figures().at("key_frames"), 7.0);
  EXPECT_LE(baseline->figures().at("key_frames"), 14.0);
}

TEST(KinectSlam, WritesItsPointMap) {
  const auto baseline = makeBaseline("kinect-3d-slam", {});
  errorAfter(*baseline, bend(4));
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      ("colonnade_point_map_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  baseline->writeMap(folder);
  std::ifstream file(folder / "map.ply", std::ios::binary);
  std::string line;
  long vertices = 0;
  while (std::getline(file, line) && line.rfind("end_header", 0) != 0)
    if (line.rfind("element vertex ", 0) == 0) vertices = std::stol(line.substr(15));
  EXPECT_GT(vertices, 10000);
  EXPECT_EQ(static_cast<double>(vertices), baseline->figures().at("map_points"));
  // Every point lies in the room, and some on the floor; grays are those of the pattern.
  const Pose2 T_world_robot = bend(1).front();
  long on_floor = 0;
  for (long i = 0; i < vertices; ++i) {
    std::array<char, 15> vertex{};
    ASSERT_TRUE(file.read(vertex.data(), vertex.size()));
    std::array<float, 3> p{};
    std::memcpy(p.data(), vertex.data(), sizeof p);
    const Eigen::Vector2d q = transform(T_world_robot, Eigen::Vector2d(p[0], p[1]));
    ASSERT_TRUE(q.x() < 4.6 && q.y() > -1.9 && q.y() < 1.7 && p[2] > -0.1 && p[2] < 2.7) << i;
    on_floor += std::abs(p[2]) < 0.03 ? 1 : 0;
    ASSERT_EQ(vertex[12], vertex[13]);
    ASSERT_GE(static_cast<unsigned char>(vertex[12]), 40);
  }
  EXPECT_GT(on_floor, vertices / 10);
  EXPECT_EQ(std::ifstream::traits_type::eof(), file.peek());
  std::filesystem::remove_all(folder);
}

TEST(KinectSlam, KeepsItsPoseWhileLostAndGoesOnFromThere) {
  BaselineOptions options;
  options.kinect.map = false;
  const auto baseline = makeBaseline("kinect-3d-slam", options);
  const PatternedRoom room;
  const std::vector<Pose2> poses = bend(24);
  Pose2 before;
  for (std::size_t i = 0; i < 10; ++i)
    before = baseline->step(room.render(i, poses[i])).T_world_robot;
  for (std::size_t i = 10; i < 13; ++i) {  // the light goes out
    Frame dark = room.render(i, poses[i]);
    dark.gray.setTo(0);
    const BaselineStep step = baseline->step(dark);
    EXPECT_FALSE(step.lost.empty());
    EXPECT_EQ(before.vector(), step.T_world_robot.vector());
  }
  Pose2 last;
  std::string lost;
  for (std::size_t i = 13; i < poses.size(); ++i) {
    const BaselineStep step = baseline->step(room.render(i, poses[i]));
    last = step.T_world_robot;
    lost = step.lost;
  }
  EXPECT_EQ("", lost);
  EXPECT_EQ(1.0, baseline->figures().at("reanchored"));
  const double way = (before.inverse() * last).translation().norm();
  EXPECT_GT(way, 0.1);   // it moves again
  EXPECT_LT(way, 0.45);  // but what passed while it was lost is lost: 0.52 m in truth
}

TEST(KinectSlam, SaysWhatAFrameLacks) {
  const auto baseline = makeBaseline("kinect-3d-slam", {});
  Frame frame = PatternedRoom().render(0, {});
  frame.depth_m.release();
  EXPECT_EQ("no depth", baseline->step(frame).lost);
  frame = PatternedRoom().render(1, {});
  frame.gray.release();
  EXPECT_EQ("no image", baseline->step(frame).lost);
}

TEST(Difodo, FollowsAKnownWayWhereTheRoomHasShape) {
  const auto baseline = makeBaseline("difodo", {});
  int lost = 0;
  const Pose2 error = errorAfter(*baseline, bend(25), &lost);
  EXPECT_EQ(0, lost);
  EXPECT_LT(error.translation().norm(), 0.15) << error.vector().transpose();
  EXPECT_LT(std::abs(error.phi), radians(3.0));
}

TEST(Difodo, KeepsItsPoseWithoutDepth) {
  const auto baseline = makeBaseline("difodo", {});
  const PatternedRoom room;
  const std::vector<Pose2> poses = bend(4);
  baseline->step(room.render(0, poses[0]));
  const Pose2 before = baseline->step(room.render(1, poses[1])).T_world_robot;
  Frame blind = room.render(2, poses[2]);
  blind.depth_m.setTo(0.0f);
  const BaselineStep lost = baseline->step(blind);
  EXPECT_FALSE(lost.lost.empty());
  EXPECT_TRUE(lost.T_world_robot.vector().isApprox(before.vector(), 1e-9));
  blind.depth_m.release();
  EXPECT_EQ("no depth", baseline->step(blind).lost);
}

}  // namespace
}  // namespace colonnade
