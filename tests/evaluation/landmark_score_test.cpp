// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/landmark_score.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

using ::testing::ElementsAre;

constexpr auto kPillar = LandmarkKind::kPillarEdge;
constexpr auto kFloor = LandmarkKind::kFloorEdge;
constexpr auto kSlope = LandmarkKind::kDepthSlope;

LandmarkRecord point(int id, LandmarkKind kind, double x, double y, int observations = 20) {
  LandmarkRecord record;
  record.id = LandmarkId{id};
  record.kind = kind;
  record.p_world = record.extent_a = record.extent_b = {x, y};
  record.covariance = Eigen::Vector2d(0.01, 0.04).asDiagonal();
  record.observations = observations;
  return record;
}

LandmarkRecord edge(int id, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                    int observations = 20) {
  LandmarkRecord record;
  record.id = LandmarkId{id};
  record.kind = kFloor;
  record.p_world = 0.5 * (a + b);
  record.extent_a = a;
  record.extent_b = b;
  const double direction = std::atan2(b.y() - a.y(), b.x() - a.x());
  record.direction = direction < 0.0 ? direction + kPi : direction;
  const Eigen::Vector2d n(-std::sin(direction), std::cos(direction));
  record.covariance = 0.01 * n * n.transpose();
  record.observations = observations;
  return record;
}

/// A wall of two pieces with a door between them, one across it, three pillars and two corners.
LandmarkMap building() {
  return {point(0, kPillar, 1, 0),   point(1, kPillar, 3, 0),    point(2, kPillar, 5, 0, 4),
          edge(3, {0, -1}, {4, -1}), edge(4, {5, -1}, {10, -1}), edge(5, {10, -1}, {10, 5}),
          point(6, kSlope, 1, 0),    point(7, kSlope, 8, 2)};
}

LandmarkMap moved(const Pose2& T, LandmarkMap map) {
  for (auto& record : map) {
    record.p_world = transform(T, record.p_world);
    record.extent_a = transform(T, record.extent_a);
    record.extent_b = transform(T, record.extent_b);
    record.covariance = T.rotation() * record.covariance * T.rotation().transpose();
    if (record.direction) *record.direction = std::fmod(*record.direction + T.phi + kPi, kPi);
  }
  return map;
}

/// A map with one flaw of every kind.
LandmarkMap flawed() {
  return {point(0, kPillar, 1.03, 0.04),      // right, 5 cm off
          point(1, kPillar, 1.2, 0.0),        // the same edge again
          point(2, kPillar, 3.0, 0.12),       // right, 12 cm off
          point(3, kPillar, 8.1, 2.0),        // no pillar edge, but a corner stands there
          point(4, kPillar, 20, 20),          // nothing there
          edge(5, {0, -1}, {3.9, -1}),        // the wall before the door
          edge(6, {5.5, -1.02}, {9, -1.02}),  // the wall behind it, 2 cm off
          edge(7, {1, -0.9}, {3, -0.9}),      // the first piece again
          edge(8, {3, 3}, {3, 6}),            // no wall there
          point(9, kSlope, 1, 0)};
}

TEST(LandmarkScore, IsPerfectForTheTruthItself) {
  const auto score = scoreLandmarks(building(), building(), {});
  for (const auto kind : {kPillar, kFloor, kSlope}) {
    EXPECT_DOUBLE_EQ(*score[kind].precision, 1.0) << name(kind);
    EXPECT_DOUBLE_EQ(*score[kind].recall, 1.0) << name(kind);
    EXPECT_EQ(score[kind].duplicates, 0U) << name(kind);
  }
  EXPECT_NEAR(*score[kPillar].position_rmse_m, 0.0, 1e-12);
  EXPECT_NEAR(*score[kFloor].length_recall, 1.0, 1e-12);
  EXPECT_NEAR(*score[kFloor].extent_on_truth, 1.0, 1e-12);
  EXPECT_NEAR(*score.walls.angle_rmse_deg, 0.0, 1e-9);
}

TEST(LandmarkScore, CountsWhatIsRightTwiceThereFalseAndMissed) {
  const auto score = scoreLandmarks(flawed(), building(), {});
  const auto& pillar = score[kPillar];
  EXPECT_EQ(pillar.estimated, 5U);
  EXPECT_EQ(pillar.right, 2U);
  EXPECT_THAT(pillar.duplicate_ids, ElementsAre(LandmarkId{1}));
  EXPECT_THAT(pillar.false_ids, ElementsAre(LandmarkId{3}, LandmarkId{4}));
  EXPECT_EQ(pillar.other_kind, 1U);
  EXPECT_DOUBLE_EQ(*pillar.precision, 0.4);
  // The third pillar was seen in 4 frames only and need not be found.
  EXPECT_EQ(pillar.true_seen, 2U);
  EXPECT_DOUBLE_EQ(*pillar.recall, 1.0);
  EXPECT_NEAR(*pillar.position_rmse_m, std::sqrt((0.05 * 0.05 + 0.12 * 0.12) / 2.0), 1e-12);
  EXPECT_NEAR(*pillar.position_median_m, 0.085, 1e-12);
  const auto& slope = score[kSlope];
  EXPECT_DOUBLE_EQ(*slope.precision, 1.0);
  EXPECT_DOUBLE_EQ(*slope.recall, 0.5);
  EXPECT_THAT(slope.missed_ids, ElementsAre(LandmarkId{7}));
}

TEST(LandmarkScore, TakesPiecesOfOneWallAsOneLineAndMeasuresItsLength) {
  const auto score = scoreLandmarks(flawed(), building(), {});
  const auto& floor = score[kFloor];
  EXPECT_EQ(floor.right, 1U);
  EXPECT_EQ(floor.further, 1U);
  EXPECT_THAT(floor.duplicate_ids, ElementsAre(LandmarkId{7}));
  EXPECT_THAT(floor.false_ids, ElementsAre(LandmarkId{8}));
  EXPECT_DOUBLE_EQ(*floor.precision, 0.5);
  EXPECT_EQ(floor.true_seen, 2U);
  EXPECT_DOUBLE_EQ(*floor.recall, 0.5);
  EXPECT_NEAR(*floor.length_recall, (3.9 + 3.5) / 15.0, 1e-9);
  EXPECT_NEAR(*floor.extent_on_truth, 1.0, 1e-9);
  EXPECT_NEAR(*floor.offset_rmse_m, 0.02 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(*floor.direction_rmse_deg, 0.0, 1e-9);
}

TEST(LandmarkScore, MeasuresOffsetDirectionAndExtentOfATurnedEdge) {
  // Turned by 2 degrees about (6, -1), from x = 3 to x = 9: 5 m of its 6 m lie beside the wall.
  const double t = std::tan(radians(2.0));
  const LandmarkMap estimate = {edge(0, {3, -1 - 3 * t}, {9, -1 + 3 * t})};
  const auto score = scoreLandmarks(estimate, building(), {});
  const auto& floor = score[kFloor];
  EXPECT_NEAR(*floor.direction_rmse_deg, 2.0, 1e-9);
  EXPECT_NEAR(*floor.extent_on_truth, 5.0 / 6.0, 1e-9);
  // The middle of what both have: (1 m about 3.5 and 4 m about 7) / 5 m = 6.3.
  EXPECT_NEAR(*floor.offset_rmse_m, 0.3 * t, 1e-9);
}

TEST(LandmarkScore, WeighsTheAnglesBetweenWallsByLength) {
  // Walls of 4, 5 and 6 m; the last one is turned by 3 degrees about its middle, so two of the
  // three pairs are wrong by 3 degrees, with the weights 24 and 30 of 74.
  LandmarkMap estimate = {edge(0, {0, -1}, {4, -1}), edge(1, {5, -1}, {10, -1})};
  const Eigen::Vector2d half =
      3.0 * Eigen::Vector2d(std::sin(radians(3.0)), std::cos(radians(3.0)));
  estimate.push_back(edge(2, Eigen::Vector2d(10, 2) - half, Eigen::Vector2d(10, 2) + half));
  const auto walls = scoreLandmarks(estimate, building(), {}).walls;
  EXPECT_EQ(walls.edges, 3U);
  EXPECT_NEAR(*walls.angle_rmse_deg, 3.0 * std::sqrt(54.0 / 74.0), 1e-9);
  EXPECT_NEAR(*walls.direction_rmse_deg, 3.0 * std::sqrt(6.0 / 15.0), 1e-9);
  // A turn of the whole estimate is no error of the angles between walls.
  const Pose2 turn{0.0, 0.0, radians(1.0)};
  const auto turned = scoreLandmarks(moved(turn, estimate), building(), {}).walls;
  EXPECT_NEAR(*turned.angle_rmse_deg, *walls.angle_rmse_deg, 1e-9);
  EXPECT_GT(*turned.direction_rmse_deg, *walls.direction_rmse_deg - 1.0);
}

TEST(LandmarkScore, DoesNotChangeWhenTheWholeEstimateMoves) {
  const Pose2 T_truth_estimate{12.0, -7.0, 2.2};
  const auto here = scoreLandmarks(flawed(), building(), {});
  const auto there =
      scoreLandmarks(moved(T_truth_estimate.inverse(), flawed()), building(), T_truth_estimate);
  for (const auto kind : {kPillar, kFloor, kSlope}) {
    EXPECT_EQ(here[kind].right, there[kind].right) << name(kind);
    EXPECT_EQ(here[kind].false_ids, there[kind].false_ids) << name(kind);
    EXPECT_EQ(here[kind].duplicate_ids, there[kind].duplicate_ids) << name(kind);
  }
  EXPECT_NEAR(*here[kPillar].position_rmse_m, *there[kPillar].position_rmse_m, 1e-9);
  EXPECT_NEAR(*here[kFloor].offset_rmse_m, *there[kFloor].offset_rmse_m, 1e-9);
  EXPECT_NEAR(*here[kFloor].length_recall, *there[kFloor].length_recall, 1e-9);
}

TEST(LandmarkScore, PrefersTheAssignmentOfLeastTotalError) {
  // Nearest first would give 0 to the truth at 0.2 and leave 1 without one.
  const LandmarkMap truth = {point(0, kPillar, 0, 0), point(1, kPillar, 0.2, 0)};
  const LandmarkMap estimate = {point(0, kPillar, 0.12, 0), point(1, kPillar, 0.4, 0)};
  const auto score = scoreLandmarks(estimate, truth, {});
  EXPECT_EQ(score[kPillar].right, 2U);
  EXPECT_NEAR(*score[kPillar].position_rmse_m, std::sqrt((0.12 * 0.12 + 0.2 * 0.2) / 2.0), 1e-12);
}

TEST(LandmarkScore, GivesSeenLandmarksTheFirstChoice) {
  const LandmarkMap truth = {point(0, kPillar, 0, 0, 0), point(1, kPillar, 0.2, 0, 30)};
  const auto score = scoreLandmarks({point(0, kPillar, 0.05, 0)}, truth, {});
  EXPECT_EQ(score[kPillar].true_found, 1U);
  // What nobody was asked to find is still no false one.
  const auto hidden = scoreLandmarks({point(0, kPillar, -0.2, 0)}, truth, {});
  EXPECT_EQ(hidden[kPillar].right, 1U);
  EXPECT_EQ(hidden[kPillar].true_found, 0U);
}

TEST(LandmarkScore, JudgesCovariancesByTheAnchorNotByTheAlignment) {
  // 0.1 m with sigma 0.1 and 0.4 m with sigma 0.2: 1 + 4, over 2. The fit would hide it.
  const LandmarkMap truth = {point(0, kPillar, 1, 1)};
  const LandmarkMap estimate = {point(0, kPillar, 1.1, 1.4)};
  LandmarkScoreOptions wide;
  wide.gate_m = 1.0;
  const Pose2 fit{-0.1, -0.4, 0.0};
  EXPECT_FALSE(scoreLandmarks(estimate, truth, fit, wide)[kPillar].nees_mean);
  const auto score = scoreLandmarks(estimate, truth, fit, wide, Anchor{});
  EXPECT_NEAR(*score[kPillar].position_rmse_m, 0.0, 1e-12);
  EXPECT_NEAR(*score[kPillar].nees_mean, 2.5, 1e-9);
  EXPECT_TRUE(score[kPillar].improbable_ids.empty());
  const auto far = scoreLandmarks({point(5, kPillar, 1.0, 1.7)}, truth, {}, wide, Anchor{});
  EXPECT_NEAR(*far[kPillar].nees_mean, 3.5 * 3.5 / 2.0, 1e-9);
  EXPECT_THAT(far[kPillar].improbable_ids, ElementsAre(LandmarkId{5}));
  // A floor edge counts across its line only: 0.2 m with sigma 0.1.
  const auto line = scoreLandmarks({edge(0, {1, -0.8}, {3, -0.8})}, building(), {}, {}, Anchor{});
  EXPECT_NEAR(*line[kFloor].nees_mean, 4.0, 1e-9);
  // An anchor in doubt by as much as the landmark says nothing.
  Anchor doubtful;
  doubtful.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  EXPECT_FALSE(scoreLandmarks(estimate, truth, fit, wide, doubtful)[kPillar].nees_mean);
}

TEST(LandmarkScore, HasNoShareWhereThereIsNothingToShare) {
  const auto score = scoreLandmarks({}, building(), {});
  EXPECT_FALSE(score[kPillar].precision);
  EXPECT_DOUBLE_EQ(*score[kPillar].recall, 0.0);
  EXPECT_FALSE(score[kPillar].position_rmse_m);
  EXPECT_FALSE(score.walls.angle_rmse_deg);
  EXPECT_THROW(scoreLandmarks(building(), {}, {}), Error);
}

}  // namespace
}  // namespace colonnade
