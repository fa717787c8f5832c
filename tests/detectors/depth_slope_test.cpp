// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

const CameraPlace kTilted{1.2, radians(10.0), radians(3.0), radians(-5.0), {0.1, 0.0}};

/// A box that shows one corner at (2, 0.2), before a wall; a room corner at (3, -1.2).
Scene corners() {
  Scene scene;
  scene.faces.push_back({{3.0, -1.2}, {3.0, 4.0}, 150.0});
  scene.faces.push_back({{0.0, -1.2}, {3.0, -1.2}, 140.0});
  scene.faces.push_back({{2.0, 0.2}, {2.4, -0.2}, 100.0});
  scene.faces.push_back({{2.0, 0.2}, {2.5, 0.7}, 80.0});
  return scene;
}

void expectAt(const Detections& found, const Eigen::Vector2d& p_robot, double tolerance_m) {
  const Eigen::Vector2d offset = p_robot - kTilted.p_robot;
  const auto* corner = nearestBearing(found, bearingOf(offset));
  ASSERT_TRUE(corner);
  const auto& z = corner->measurement.z;
  const Eigen::Vector2d seen = z[1] * Eigen::Vector2d(std::cos(z[0]), std::sin(z[0]));
  EXPECT_LT((seen - offset).norm(), tolerance_m)
      << "true " << offset.transpose() << " seen " << seen.transpose();
}

TEST(DepthSlopeDetector, PlacesCornersWithinTwoCentimetres) {
  const Frame frame = render(corners(), kTilted);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const auto found = DepthSlopeDetector().detect(withNoise(frame, 0.0, seed), EdgeLines{});
    const auto good = accepted(found, LandmarkKind::kDepthSlope);
    expectAt(good, {2.0, 0.2}, 0.02);
    expectAt(good, {3.0, -1.2}, 0.03);  // at 3.1 m a depth pixel is worth 1.5 cm
  }
}

TEST(DepthSlopeDetector, AJumpBelongsToItsNearSide) {
  const auto found = DepthSlopeDetector().detect(render(corners(), kTilted), EdgeLines{});
  const auto good = accepted(found, LandmarkKind::kDepthSlope);
  expectAt(good, {2.4, -0.2}, 0.03);
  expectAt(good, {2.5, 0.7}, 0.03);
  EXPECT_EQ(good.size(), 4U);  // and none on the wall behind
}

TEST(DepthSlopeDetector, AFlatWallHasNoCorners) {
  Scene scene;
  scene.faces.push_back({{3.5, -6.0}, {1.0, 6.0}, 150.0});
  const Frame frame = render(scene, kTilted);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const auto found = DepthSlopeDetector().detect(withNoise(frame, 0.0, seed), EdgeLines{});
    EXPECT_TRUE(accepted(found, LandmarkKind::kDepthSlope).empty());
  }
}

TEST(DepthSlopeDetector, StaysInsideItsGate) {
  DepthSlopeOptions options;
  options.max_range_m = 2.3;
  for (const auto& corner :
       DepthSlopeDetector(options).detect(render(corners(), kTilted), EdgeLines{})) {
    EXPECT_LE(corner.measurement.z[1], 2.35);
    EXPECT_GE(corner.measurement.z[1], options.min_range_m - 0.05);
  }
}

TEST(DepthSlopeDetector, BridgesColumnsWithoutDepth) {
  Frame frame = render(corners(), kTilted);
  const LevelledCamera camera(frame);
  const auto p_px = camera.project({2.0, 0.2, 1.0});
  ASSERT_TRUE(p_px);
  const int u = static_cast<int>(p_px->x());
  frame.depth_m.colRange(u - 6, u + 7).setTo(0.0F);  // sharp edges reflect the pattern away
  const auto found = DepthSlopeDetector().detect(frame, EdgeLines{});
  expectAt(accepted(found, LandmarkKind::kDepthSlope), {2.0, 0.2}, 0.03);
}

TEST(DepthSlopeDetector, RefusesWhatIsNotTheSameAtAllHeights) {
  Scene scene;
  scene.faces.push_back({{3.0, -6.0}, {3.0, 6.0}, 150.0});
  scene.faces.push_back({{2.2, -0.3}, {2.2, 0.3}, 80.0, 0.9, 1.05});  // a box on the wall
  const auto found = DepthSlopeDetector().detect(render(scene, {}), EdgeLines{});
  EXPECT_TRUE(accepted(found, LandmarkKind::kDepthSlope).empty());
}

TEST(WallDirectionDetector, MeasuresDirectionsModuloAQuarterTurn) {
  Scene scene;
  const double turn = radians(12.0);
  const Eigen::Rotation2Dd R(turn);
  const auto at = [&](double x, double y) -> Eigen::Vector2d { return R * Eigen::Vector2d(x, y); };
  scene.faces.push_back({at(-1.0, 1.0), at(4.0, 1.0)});
  scene.faces.push_back({at(-1.0, -1.2), at(4.0, -1.2)});
  scene.faces.push_back({at(4.0, -1.2), at(4.0, 1.0)});
  const CameraPlace place{1.2, radians(5.0), radians(2.0), radians(10.0), {0.0, 0.0}};
  const auto walls = WallDirectionDetector().detect(withNoise(render(scene, place), 0.0, 4));
  ASSERT_EQ(walls.size(), 3U);
  for (const auto& wall : walls) {
    EXPECT_NEAR(wrapQuarterTurn(wall.direction - turn), 0.0, 3.0 * wall.sigma);
    EXPECT_NEAR(wrapQuarterTurn(wall.direction - turn), 0.0, radians(1.0));
    EXPECT_GE(wall.length_m, 0.5);
    const Eigen::Vector2d along = wall.p_robot_b - wall.p_robot_a;
    EXPECT_NEAR(wrapQuarterTurn(bearingOf(along) - wall.direction), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace colonnade::testing
