// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

constexpr double kFocal_px = 535.0;
const CameraPlace kTilted{1.2, radians(15.0), radians(4.0), 0.0, {0.1, -0.05}};

/// A pillar 0.4 m wide before a wall, and a door painted on that wall.
Scene pillarScene() {
  Scene scene;
  scene.faces.push_back({{4.0, -4.0}, {4.0, 4.0}, 150.0});
  scene.faces.push_back({{3.99, -1.6}, {3.99, -0.8}, 90.0, 0.0, 2.0});
  scene.faces.push_back({{2.5, 0.3}, {2.5, 0.7}, 60.0});
  return scene;
}

const Eigen::Vector2d kEdges[] = {{2.5, 0.3}, {2.5, 0.7}, {3.99, -1.6}, {3.99, -0.8}};

TEST(PillarDetector, MeasuresEdgesThroughATiltedCamera) {
  const Frame frame = withNoise(render(pillarScene(), kTilted), 2.0, 1);
  const auto pillars = accepted(detectAll(frame), LandmarkKind::kPillarEdge);
  EXPECT_EQ(pillars.size(), std::size(kEdges));
  for (const auto& p_robot : kEdges) {
    const Eigen::Vector2d offset = p_robot - kTilted.p_robot;
    const auto* pillar = nearestBearing(pillars, bearingOf(offset));
    ASSERT_TRUE(pillar);
    const auto& m = pillar->measurement;
    EXPECT_NEAR(m.z[0], bearingOf(offset), 0.5 / kFocal_px) << p_robot.transpose();
    ASSERT_TRUE(m.hasRange()) << p_robot.transpose();
    EXPECT_NEAR(m.z[1], offset.norm(), 0.02 + 0.01 * offset.norm()) << p_robot.transpose();
    EXPECT_LT((m.p_robot_camera - kTilted.p_robot).norm(), 1e-9);
  }
}

TEST(PillarDetector, FindsVerticalsThatLeanFarOverInTheImage) {
  // Rolled by 25 degrees and looking 30 degrees down: no vertical is near the image's vertical.
  const CameraPlace place{1.5, radians(30.0), radians(25.0), 0.0, {0.0, 0.0}};
  Scene scene;
  scene.faces.push_back({{4.0, -6.0}, {4.0, 6.0}, 160.0});
  scene.faces.push_back({{2.2, -0.3}, {2.2, 0.2}, 60.0});
  const auto pillars = accepted(detectAll(render(scene, place)), LandmarkKind::kPillarEdge);
  for (const auto& p_robot : {Eigen::Vector2d(2.2, -0.3), Eigen::Vector2d(2.2, 0.2)}) {
    const auto* pillar = nearestBearing(pillars, bearingOf(p_robot));
    ASSERT_TRUE(pillar);
    EXPECT_NEAR(pillar->measurement.z[0], bearingOf(p_robot), 0.5 / kFocal_px);
  }
}

TEST(PillarDetector, JoinsTheEdgesOfAPillar) {
  const auto detections = detectAll(render(pillarScene(), kTilted));
  int in_pairs = 0;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    if (!detections[i].partner) continue;
    ++in_pairs;
    const auto& partner = detections.at(*detections[i].partner);
    ASSERT_TRUE(partner.partner);
    EXPECT_EQ(*partner.partner, i);
    EXPECT_NE(partner.appearance.gradient_sign, detections[i].appearance.gradient_sign);
    const bool is_door = std::abs(detections[i].width_m - 0.8) < 0.05;
    const bool is_pillar = std::abs(detections[i].width_m - 0.4) < 0.05;
    EXPECT_TRUE(is_door || is_pillar) << detections[i].width_m;
  }
  EXPECT_EQ(in_pairs, 4);
}

TEST(PillarDetector, TellsTheSidesOfAnEdgeApart) {
  const auto pillars =
      accepted(detectAll(render(pillarScene(), kTilted)), LandmarkKind::kPillarEdge);
  const auto* left = nearestBearing(pillars, bearingOf(kEdges[1] - kTilted.p_robot));
  ASSERT_TRUE(left);
  EXPECT_EQ(left->appearance.gradient_sign,
            -1);  // bright wall on its left, dark pillar on its right
  EXPECT_NEAR(left->appearance.left[0], 150.0, 15.0);  // some floor below the wall
  EXPECT_NEAR(left->appearance.right[0], 60.0, 5.0);
}

TEST(PillarDetector, GivesBearingsWithoutDepth) {
  Frame frame = render(pillarScene(), kTilted);
  frame.depth_m.release();
  const auto pillars = accepted(detectAll(frame), LandmarkKind::kPillarEdge);
  EXPECT_GE(pillars.size(), 4U);
  for (const auto& pillar : pillars) {
    EXPECT_FALSE(pillar.measurement.hasRange());
    EXPECT_EQ(pillar.measurement.R.rows(), 1);
    EXPECT_GT(pillar.measurement.R(0, 0), 0.0);
  }
}

TEST(PillarDetector, GivesNoRangeWhereDepthCannotBeTrusted) {
  Scene scene;
  scene.faces.push_back({{7.5, -6.0}, {7.5, 6.0}, 150.0});
  scene.faces.push_back({{6.5, -0.5}, {6.5, 0.5}, 60.0});
  const auto pillars = accepted(detectAll(render(scene, {})), LandmarkKind::kPillarEdge);
  ASSERT_GE(pillars.size(), 2U);
  for (const auto& pillar : pillars) EXPECT_FALSE(pillar.measurement.hasRange());
}

TEST(PillarDetector, RefusesAStripeOnTheFloorThatLooksUpright) {
  Scene scene;
  scene.faces.push_back({{6.0, -6.0}, {6.0, 6.0}, 150.0});
  scene.strips.push_back({{1.5, 0.0}, {4.0, 0.0}, 0.2});
  const CameraPlace place{1.2, radians(20.0), 0.0, 0.0, {0.0, 0.0}};
  DetectorOptions options;
  options.pillars.vertical_tolerance = radians(15.0);
  const auto all = detectAll(render(scene, place), options);
  int refused = 0;
  for (const auto& detection : all) {
    if (detection.kind() != LandmarkKind::kPillarEdge) continue;
    EXPECT_FALSE(detection.accepted()) << detection.a_px.transpose();
    if (detection.refusal == "lies on the floor") ++refused;
  }
  EXPECT_GE(refused, 2);
}

TEST(PillarDetector, RefusesABoardThatLeansAway) {
  Scene scene;
  scene.faces.push_back({{6.0, -6.0}, {6.0, 6.0}, 150.0});
  scene.faces.push_back({{2.0, -0.2}, {2.0, 0.2}, 60.0, 0.0, 1.6, 0.3});
  const auto all = detectAll(render(scene, {}));
  int refused = 0;
  for (const auto& detection : all) {
    if (detection.kind() != LandmarkKind::kPillarEdge) continue;
    EXPECT_FALSE(detection.accepted());
    if (detection.refusal == "not upright in space") ++refused;
  }
  EXPECT_GE(refused, 2);
}

}  // namespace
}  // namespace colonnade::testing
