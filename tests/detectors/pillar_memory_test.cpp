// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

constexpr const char* kReason = "was too low for a part of the building";

Detection edgeAt(const Eigen::Vector2d& p_robot, UprightHeight height, double top_px = 5.0) {
  Detection edge;
  edge.measurement.z = Eigen::Vector2d(bearingOf(p_robot), p_robot.norm());
  edge.measurement.R = Eigen::Matrix2d::Identity();
  edge.a_px = {300.0, top_px};
  edge.b_px = {300.0, 400.0};
  edge.range_m = p_robot.norm();
  edge.height = height;
  if (height == UprightHeight::kLow) edge.refusal = "too low for a part of the building";
  return edge;
}

/// The refusal of an edge of unknown height, seen after the robot has gone a way.
std::string refusalAfter(PillarMemory& memory, const std::optional<Pose2>& way,
                         const Eigen::Vector2d& p_robot) {
  Detections now{edgeAt(p_robot, UprightHeight::kUnknown)};
  memory.judge(now, {}, way);
  return now[0].refusal;
}

void show(PillarMemory& memory, Detections seen) { memory.judge(seen, {}, Pose2{}); }

TEST(PillarMemory, WhatWasSeenToBeLowIsRefusedFromNear) {
  PillarMemory memory;
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, Pose2{1.5, 0.0, 0.0}, {1.5, 0.5}), kReason);
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {1.5, 1.0}), "");  // another one
  // Turned to the left by 90 degrees the robot has it on its right.
  EXPECT_EQ(refusalAfter(memory, Pose2{0.0, 0.0, kPi / 2}, {0.5, -1.5}), kReason);
}

TEST(PillarMemory, ForgetsWhenTheMotionIsNotKnownAndAfterALongWay) {
  PillarMemory memory;
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, std::nullopt, {3.0, 0.5}), "");
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, Pose2{16.0, 0.0, 0.0}, {-13.0, 0.5}), "");
}

TEST(PillarMemory, TheMoreFrequentSightCounts) {
  PillarMemory memory;
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kTall)});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {3.0, 0.5}), "");
  show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {3.0, 0.5}), kReason);
}

TEST(PillarMemory, APillarWhoseLowerPartIsBrighterThanTheFloorStays) {
  // Darker than the wall above, brighter than the floor below: two edges, and the lower one ends.
  PillarMemory memory;
  for (int i = 0; i < 3; ++i) {
    Detections seen{edgeAt({1.87, 0.5}, UprightHeight::kUnknown, 3.0),
                    edgeAt({1.87, 0.5}, UprightHeight::kLow, 225.0)};
    memory.judge(seen, {}, Pose2{});
    EXPECT_TRUE(seen[0].accepted()) << i;
  }
}

TEST(PillarMemory, APartnerOfWhatIsRefusedStandsAlone) {
  PillarMemory memory;
  show(memory, {edgeAt({2.0, 0.5}, UprightHeight::kLow)});
  Detections pair{edgeAt({2.0, 0.5}, UprightHeight::kUnknown),
                  edgeAt({2.0, 1.0}, UprightHeight::kUnknown)};
  pair[0].partner = 1;
  pair[1].partner = 0;
  memory.judge(pair, {}, Pose2{});
  EXPECT_FALSE(pair[0].accepted());
  EXPECT_TRUE(pair[1].accepted());
  EXPECT_FALSE(pair[1].partner);
}

TEST(PillarMemory, OfTooManyPlacesThoseNotSeenForLongestAreForgotten) {
  PillarMemory memory;
  Detections many;
  for (int i = 0; i < 500; ++i)
    many.push_back(edgeAt({3.0 + 0.3 * (i / 20), 0.3 * (i % 20)}, UprightHeight::kLow));
  memory.judge(many, {}, Pose2{});
  Detections first{edgeAt({2.0, 0.0}, UprightHeight::kLow)};
  memory.judge(first, {}, Pose2{1.0, 0.0, 0.0});
  show(memory, {edgeAt({1.0, -3.0}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {2.0, 0.0}), kReason);
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {2.0, 0.3}), "");
}

TEST(PillarMemory, WhatMovesIsNotRemembered) {
  Segmentation all_moves;
  all_moves.cell_px = 640;
  all_moves.columns = all_moves.rows = 1;
  all_moves.labels = {Segmentation::kMoving};
  PillarMemory memory;
  Detections seen{edgeAt({3.0, 0.5}, UprightHeight::kLow)};
  memory.judge(seen, all_moves, Pose2{});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {3.0, 0.5}), "");
}

TEST(PillarMemory, WhatChangedIsBelievedAfterHalfAsManySights) {
  // However often it was low: counts are halved, so that tall sights catch up.
  PillarMemory memory;
  for (int i = 0; i < 200; ++i) show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kLow)});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {3.0, 0.5}), kReason);
  for (int i = 0; i < 20; ++i) show(memory, {edgeAt({3.0, 0.5}, UprightHeight::kTall)});
  EXPECT_EQ(refusalAfter(memory, Pose2{}, {3.0, 0.5}), "");
}

/// A wall, a pillar before it and a cabinet, 1.25 m tall, from a robot that has driven so far.
Frame roomFrom(double x_m) {
  Scene scene{{{{4.5 - x_m, -5.0}, {4.5 - x_m, 5.0}, 150.0},
               {{3.2 - x_m, -0.9}, {3.2 - x_m, -0.5}, 70.0},
               {{3.0 - x_m, 0.1}, {3.0 - x_m, 0.6}, 60.0, 0.0, 1.25}},
              {}};
  return withNoise(render(scene, {0.9, radians(12.0), 0.0, 0.0, {0.0, 0.0}}), 2.0, 3);
}

TEST(PillarMemory, ACabinetWhoseTopHasLeftThePictureIsRefusedAndAPillarIsNot) {
  const auto backend = makeEdgeLineBackend(kDefaultBackend, {});
  const auto columns = [](const Detections& all, double y_m, double x_m) {
    const double bearing = bearingOf({x_m, y_m});
    return std::count_if(all.begin(), all.end(), [&](const Detection& d) {
      return d.accepted() && d.kind() == LandmarkKind::kPillarEdge &&
             std::abs(d.measurement.z[0] - bearing) < 0.01;
    });
  };
  constexpr double kWay_m = 1.75;
  const Frame far = roomFrom(0.0), near = roomFrom(kWay_m);
  DetectorBank blank, bank;
  const auto alone = blank.detect(near, backend->extract(near.gray), Pose2{});
  EXPECT_GT(columns(alone, 0.1, 3.0 - kWay_m), 0);  // one picture does not tell
  bank.detect(far, backend->extract(far.gray), Pose2{});
  const auto all = bank.detect(near, backend->extract(near.gray), Pose2{kWay_m, 0.0, 0.0});
  EXPECT_EQ(columns(all, 0.1, 3.0 - kWay_m), 0);
  EXPECT_EQ(columns(all, 0.6, 3.0 - kWay_m), 0);
  EXPECT_GT(columns(all, -0.5, 3.2 - kWay_m), 0);
}

TEST(PillarMemory, GoesAlongThroughAFrameWithoutCalibration) {
  const auto backend = makeEdgeLineBackend(kDefaultBackend, {});
  constexpr double kWay_m = 1.75;
  const Frame far = roomFrom(0.0), near = roomFrom(kWay_m);
  Frame between = roomFrom(0.5 * kWay_m);
  between.camera.fx_px = 0.0;
  ASSERT_FALSE(between.camera.isCalibrated());
  DetectorBank bank;
  bank.detect(far, backend->extract(far.gray), Pose2{});
  const Pose2 half{0.5 * kWay_m, 0.0, 0.0};
  EXPECT_TRUE(bank.detect(between, backend->extract(between.gray), half).empty());
  const auto all = bank.detect(near, backend->extract(near.gray), half);
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const Detection& d) { return d.refusal == kReason; }));
}

}  // namespace
}  // namespace colonnade::testing
