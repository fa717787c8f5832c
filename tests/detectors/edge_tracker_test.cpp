// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/edge_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace colonnade {
namespace {

/// An edge of the world seen from a robot that drives along x.
struct TrueEdge {
  Eigen::Vector2d p_world;
  int sign = 1;
  float left = 60.0F, right = 150.0F;
  bool ranged = true;
};

Detection seen(const TrueEdge& edge, const Pose2& T_world_robot) {
  const Eigen::Vector2d p_robot = transform(T_world_robot.inverse(), edge.p_world);
  Detection d;
  d.measurement.z.resize(edge.ranged ? 2 : 1);
  d.measurement.z[0] = std::atan2(p_robot.y(), p_robot.x());
  if (edge.ranged) d.measurement.z[1] = p_robot.norm();
  d.measurement.R =
      1e-5 * Eigen::MatrixXd::Identity(d.measurement.z.size(), d.measurement.z.size());
  d.appearance = {edge.sign, Eigen::Vector3f::Constant(edge.left),
                  Eigen::Vector3f::Constant(edge.right)};
  const double column = 320.0 - 500.0 * p_robot.y() / p_robot.x();
  d.a_px = {column, 100.0};
  d.b_px = {column, 300.0};
  return d;
}

constexpr double kStep_m = 0.05, kStep_s = 0.1;

class Tracks : public ::testing::Test {
 protected:
  /// Ids of the edges after a frame in which the robot has moved by one step.
  std::vector<std::optional<int>> frame(const std::vector<TrueEdge>& edges,
                                        double step_m = kStep_m) {
    T_world_robot_.x += step_m;
    Detections all;
    for (const auto& edge : edges) all.push_back(seen(edge, T_world_robot_));
    return tracker_.step(all, {step_m, 0.0, 0.0}, kStep_s);
  }
  EdgeTracker::Phase phaseOf(int id) const { return tracker_.find(id)->phase; }

  Pose2 T_world_robot_;
  EdgeTracker tracker_;
};

TEST_F(Tracks, ConfirmsAllCandidatesOfEqualWidthNotOnlyOne) {
  // Two pillars 0.4 m wide side by side: result 4 of the thesis, where one of them is lost.
  const std::vector<TrueEdge> edges{
      {{4.0, 1.0}, 1}, {{4.0, 0.6}, -1}, {{4.0, -0.6}, 1}, {{4.0, -1.0}, -1}};
  std::vector<std::optional<int>> first = frame(edges), last;
  for (int i = 0; i < 11; ++i) last = frame(edges);
  EXPECT_EQ(first, last);
  for (const auto& id : last) EXPECT_EQ(EdgeTracker::Phase::kConfirmed, phaseOf(*id));
}

TEST_F(Tracks, PassesThroughLearningAndChecking) {
  const std::vector<TrueEdge> edge{{{4.0, 1.0}}};
  const int id = *frame(edge).front();
  for (int i = 1; i < 4; ++i) frame(edge);
  EXPECT_EQ(EdgeTracker::Phase::kLearning, phaseOf(id));
  frame(edge);
  EXPECT_EQ(EdgeTracker::Phase::kChecking, phaseOf(id));
  // Seen in two of the five frames of checking: not confirmed, learned again.
  frame(edge), frame({}), frame({}), frame({}), frame(edge);
  EXPECT_EQ(EdgeTracker::Phase::kLearning, phaseOf(id));
}

TEST_F(Tracks, AFasterRobotChecksSooner) {
  const std::vector<TrueEdge> edge{{{9.0, 1.0}}};
  const int id = *frame(edge, 0.1).front();  // 1 m/s, twice the speed of the cycle
  for (int i = 0; i < 5; ++i) frame(edge, 0.1);
  EXPECT_EQ(EdgeTracker::Phase::kConfirmed, phaseOf(id));
}

TEST_F(Tracks, TellsEdgesThatPassOneAnotherApart) {
  // A near and a far edge of one sign and colour, whose bearings cross on the way (figure 15).
  const std::vector<TrueEdge> edges{{{2.0, 0.5}}, {{5.0, 1.05}}};
  const auto first = frame(edges);
  auto last = first;
  for (int i = 0; i < 20; ++i) last = frame(edges);
  EXPECT_EQ(first, last);
  // The same without range, but of other colours.
  tracker_ = EdgeTracker();
  T_world_robot_ = {};
  const std::vector<TrueEdge> faces{{{2.0, 0.5}, 1, 60, 150, false},
                                    {{5.0, 1.05}, 1, 120, 210, false}};
  const auto before = frame(faces);
  for (int i = 0; i < 20; ++i) last = frame(faces);
  EXPECT_EQ(before, last);
}

TEST_F(Tracks, WhatMovesIsNotConfirmed) {
  std::set<int> ids;
  for (int i = 0; i < 25; ++i) {  // walks across at 1.3 m/s, 3 m ahead
    const auto id = frame({{{3.0 + T_world_robot_.x, 1.6 - 0.13 * i}}}).front();
    EXPECT_NE(EdgeTracker::Phase::kConfirmed, phaseOf(*id)) << i;
    ids.insert(*id);
  }
  EXPECT_GT(ids.size(), 3U);
}

TEST_F(Tracks, RefusedAndOtherDetectionsHaveNone) {
  Detections all{seen({{4.0, 0.5}}, {}), seen({{4.0, -0.5}}, {})};
  all[0].refusal = "lies on the floor";
  all[1].measurement.kind = LandmarkKind::kFloorEdge;
  const auto ids = tracker_.step(all, {}, 0.0);
  EXPECT_FALSE(ids[0] || ids[1]);
}

}  // namespace
}  // namespace colonnade
