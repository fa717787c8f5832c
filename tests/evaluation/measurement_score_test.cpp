// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/measurement_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace colonnade {
namespace {

MeasuredLandmark measured(LandmarkKind kind, double angle, double distance_m, double sigma,
                          double sigma_m) {
  MeasuredLandmark one;
  one.measurement.kind = kind;
  one.measurement.z = Eigen::Vector2d(angle, distance_m);
  one.measurement.R = Eigen::Vector2d(sigma * sigma, sigma_m * sigma_m).asDiagonal();
  return one;
}

TEST(MeasurementScore, JudgesCornersInMetresAndTheirCovariance) {
  MeasurementScore score;
  score.add({measured(LandmarkKind::kDepthSlope, 0.01, 2.03, 0.01, 0.03),
             measured(LandmarkKind::kDepthSlope, 1.0, 2.0, 0.01, 0.03)},
            {{LandmarkKind::kDepthSlope, {2.0, 0.0}, {2.0, 0.0}},
             {LandmarkKind::kFloorEdge, {1.08, 1.68}, {1.0, 1.0}}});
  const auto& kind = score.of(LandmarkKind::kDepthSlope);
  EXPECT_DOUBLE_EQ(0.5, *kind.precision());
  EXPECT_NEAR(1.0, *kind.nees(), 1e-9);  // one sigma in both
  EXPECT_NEAR(std::hypot(0.03, 2.03 * 0.01), *kind.place_near.rms(), 1e-3);
  EXPECT_FALSE(kind.place_far.rms());
}

TEST(MeasurementScore, JudgesFloorEdgesAcrossTheLine) {
  auto edge = measured(LandmarkKind::kFloorEdge, radians(90.5), 1.52, radians(0.5), 0.01);
  edge.p_robot_a = {0.0, 1.5};
  edge.p_robot_b = {2.0, 1.5};
  const LandmarkInView there{LandmarkKind::kFloorEdge, {-1.0, 1.5}, {4.0, 1.5}};
  MeasurementScore score;
  score.add({edge}, {there});
  EXPECT_NEAR(radians(0.5), *score.of(LandmarkKind::kFloorEdge).direction.rms(), 1e-9);
  EXPECT_NEAR(0.02, *score.of(LandmarkKind::kFloorEdge).place.rms(), 1e-9);
  EXPECT_NEAR(2.5, *score.of(LandmarkKind::kFloorEdge).nees(), 1e-9);

  MeasurementScore elsewhere;  // in line with it, but not beside it
  elsewhere.add({edge}, {{LandmarkKind::kFloorEdge, {3.0, 1.5}, {5.0, 1.5}}});
  EXPECT_EQ(0U, elsewhere.of(LandmarkKind::kFloorEdge).matched);
}

TEST(MeasurementScore, BringsTheMapIntoTheRobotsAxes) {
  LandmarkRecord record;
  record.id = LandmarkId{7};
  record.kind = LandmarkKind::kDepthSlope;
  record.p_world = record.extent_a = record.extent_b = {1.0, 3.0};
  StampedPose pose;
  pose.stamp_s = 2.0;
  pose.T_world_body.translation() = Eigen::Vector3d(1.0, 1.0, 0.0);
  pose.T_world_body.linear() =
      Eigen::AngleAxisd(radians(90.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  TrueImageLine line;
  line.kind = LandmarkKind::kDepthSlope;
  line.landmark = 7;
  const auto views = landmarksInView({record}, {pose}, {{microseconds(2.0), {line}}});
  ASSERT_EQ(1U, views.size());
  ASSERT_EQ(1U, views.begin()->second.size());
  EXPECT_LT((views.begin()->second[0].p_robot_a - Eigen::Vector2d(2.0, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace colonnade
