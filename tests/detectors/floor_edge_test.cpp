// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

const CameraPlace kTilted{1.2, radians(12.0), radians(-3.0), radians(8.0), {0.1, 0.05}};

/// A corridor 2.2 m wide with an end wall 4.5 m ahead.
Scene corridor() {
  Scene scene;
  scene.faces.push_back({{-1.0, 1.1}, {4.5, 1.1}, 110.0});
  scene.faces.push_back({{-1.0, -1.1}, {4.5, -1.1}, 120.0});
  scene.faces.push_back({{4.5, -1.1}, {4.5, 1.1}, 100.0});
  return scene;
}

const Detection* edgeTowards(const Detections& edges, double direction) {
  const auto* edge = nearestBearing(edges, direction);
  return edge && std::abs(wrapAngle(edge->measurement.z[0] - direction)) < radians(10) ? edge
                                                                                       : nullptr;
}

TEST(FloorEdgeDetector, MeasuresTheThreeSidesOfACorridor) {
  for (const bool with_depth : {true, false}) {
    Frame frame = withNoise(render(corridor(), kTilted), 2.0, 3);
    if (!with_depth) frame.depth_m.release();
    const auto edges = accepted(detectAll(frame), LandmarkKind::kFloorEdge);
    EXPECT_EQ(edges.size(), 3U);
    const struct {
      double direction, distance_m;
    } sides[] = {{kPi / 2, 1.1 - 0.05}, {-kPi / 2, 1.1 + 0.05}, {0.0, 4.5 - 0.1}};
    for (const auto& side : sides) {
      const auto* edge = edgeTowards(edges, side.direction);
      ASSERT_TRUE(edge) << degrees(side.direction) << " depth " << with_depth;
      // Pixels at 4.4 m are worth more than those at 1 m: (D^2 + H^2) / (H f) = 3.2 cm each.
      const double tolerance_m = side.distance_m > 2.0 ? 0.03 : 0.01;
      EXPECT_NEAR(wrapAngle(edge->measurement.z[0] - side.direction), 0.0, radians(0.3));
      EXPECT_NEAR(edge->measurement.z[1], side.distance_m, tolerance_m);
    }
  }
}

TEST(FloorEdgeDetector, EndsLieOnTheLineInTheRobotsAxes) {
  const auto edges = accepted(detectAll(render(corridor(), kTilted)), LandmarkKind::kFloorEdge);
  const auto* left = edgeTowards(edges, kPi / 2);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->p_robot_a.y(), 1.1, 0.02);
  EXPECT_NEAR(left->p_robot_b.y(), 1.1, 0.02);
  EXPECT_GT(std::abs(left->p_robot_a.x() - left->p_robot_b.x()), 1.0);
  EXPECT_EQ(left->appearance.gradient_sign, -1);  // bright floor, darker wall on the far side
}

TEST(FloorEdgeDetector, TakesTheFootOfASkirtingBoard) {
  for (const bool with_depth : {true, false}) {
    Scene scene = corridor();
    scene.faces.push_back({{-1.0, 1.095}, {4.5, 1.095}, 40.0, 0.0, 0.1});
    Frame frame = render(scene, kTilted);
    if (!with_depth) frame.depth_m.release();
    const auto all = detectAll(frame);
    const auto edges = accepted(all, LandmarkKind::kFloorEdge);
    const auto* left = edgeTowards(edges, kPi / 2);
    ASSERT_TRUE(left) << with_depth;
    EXPECT_NEAR(left->measurement.z[1], 1.095 - 0.05, 0.012) << with_depth;
    int on_the_left = 0;
    int refused = 0;
    for (const auto& detection : all) {
      if (detection.kind() != LandmarkKind::kFloorEdge) continue;
      if (std::abs(wrapAngle(detection.measurement.z[0] - kPi / 2)) > radians(5)) continue;
      ++(detection.accepted() ? on_the_left : refused);
    }
    EXPECT_EQ(on_the_left, 1) << with_depth;
    EXPECT_GE(refused, 1) << with_depth;
  }
}

TEST(FloorEdgeDetector, TakesTheFootOfAWallAndNotAJointOfTheFloorBeforeIt) {
  // A strip of darker tiles 9 cm wide before the wall: nearer than the tilt lets depth tell.
  Scene scene;
  scene.faces.push_back({{2.17, -3.0}, {2.17, 3.0}, 60.0});
  scene.strips.push_back({{2.125, -3.0}, {2.125, 3.0}, 0.09, 130.0});
  const Frame frame = withNoise(render(scene, {0.9, radians(12.0), 0.0, 0.0, {0.0, 0.0}}), 2.0, 5);
  const auto all = detectAll(frame);
  const auto edges = accepted(all, LandmarkKind::kFloorEdge);
  const auto* foot = edgeTowards(edges, 0.0);
  ASSERT_TRUE(foot);
  EXPECT_NEAR(foot->measurement.z[1], 2.17, 0.01);
  int joints = 0;
  for (const auto& detection : all)
    if (detection.refusal == "floor goes on behind it" && detection.measurement.z[1] < 2.1)
      ++joints;
  EXPECT_GE(joints, 1);
}

TEST(FloorEdgeDetector, WithoutDepthALineWithTheSameFloorOnBothSidesIsAJoint) {
  for (const double skirting_gray : {110.0, 40.0}) {  // none, and a dark one
    Scene scene = corridor();
    scene.faces.push_back({{-1.0, 1.095}, {4.5, 1.095}, skirting_gray, 0.0, 0.1});
    for (const double y_m : {-0.6, 0.5}) scene.strips.push_back({{0.5, y_m}, {4.4, y_m}, 0.012});
    for (const double x_m : {2.0, 2.6}) scene.strips.push_back({{x_m, -1.0}, {x_m, 1.0}, 0.012});
    Frame frame = withNoise(render(scene, kTilted), 2.0, 7);
    frame.depth_m.release();
    int joints = 0, feet = 0;
    for (const auto& edge : accepted(detectAll(frame), LandmarkKind::kFloorEdge)) {
      const Eigen::Vector2d middle = 0.5 * (edge.p_robot_a + edge.p_robot_b);
      const bool is_foot = std::abs(middle.y()) > 1.0 || middle.x() > 4.2;
      EXPECT_EQ(is_foot, !edge.on_surface) << middle.transpose() << " " << skirting_gray;
      ++(is_foot ? feet : joints);
    }
    EXPECT_EQ(feet, 3) << skirting_gray;
    EXPECT_GE(joints, 4) << skirting_gray;
  }
}

TEST(FloorEdgeDetector, AJointAlongTheFootOfAWallLeavesItWhatItIs) {
  Scene scene = corridor();
  scene.strips.push_back({{0.5, 1.0}, {4.4, 1.0}, 0.012});
  Frame frame = withNoise(render(scene, kTilted), 2.0, 7);
  frame.depth_m.release();
  int feet = 0, joints = 0;
  for (const auto& edge : accepted(detectAll(frame), LandmarkKind::kFloorEdge)) {
    if (edge.p_robot_a.y() < 0.9 || edge.p_robot_b.y() < 0.9) continue;
    ++(edge.on_surface ? joints : feet);
    EXPECT_NEAR(edge.p_robot_a.y(), edge.on_surface ? 1.0 : 1.1, 0.02);
  }
  EXPECT_EQ(feet, 1);
  EXPECT_EQ(joints, 1);
}

TEST(FloorEdgeDetector, RefusesPaintOnTheFloorWhenDepthShowsThatItGoesOn) {
  Scene scene;
  scene.faces.push_back({{6.0, -6.0}, {6.0, 6.0}, 150.0});
  scene.strips.push_back({{1.0, 0.6}, {5.0, 0.6}, 0.15});
  scene.strips.push_back({{2.5, -1.5}, {2.5, 1.5}, 0.15});
  const auto all = detectAll(render(scene, {1.2, radians(20.0), 0.0, 0.0, {0.0, 0.0}}));
  int refused = 0;
  for (const auto& detection : all) {
    if (detection.kind() != LandmarkKind::kFloorEdge) continue;
    if (detection.measurement.z[1] > 4.5) continue;
    EXPECT_FALSE(detection.accepted());
    if (detection.refusal == "floor goes on behind it") ++refused;
  }
  EXPECT_GE(refused, 3);
}

TEST(FloorEdgeDetector, ALowCameraDoesNotTakeTheHorizonForAFloorEdge) {
  // Camera below the wall's picture rail: lines above the horizon cannot be on the floor.
  Scene scene;
  scene.faces.push_back({{3.0, -5.0}, {3.0, 5.0}, 150.0});
  scene.faces.push_back({{2.99, -5.0}, {2.99, 5.0}, 60.0, 0.9, 1.2});
  const auto all = detectAll(render(scene, {0.4, radians(2.0), 0.0, 0.0, {0.0, 0.0}}));
  const auto edges = accepted(all, LandmarkKind::kFloorEdge);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].measurement.z[1], 3.0, 0.05);
}

}  // namespace
}  // namespace colonnade::testing
