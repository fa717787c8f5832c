// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "colonnade/detectors/depth_slope_pixels.hpp"
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

TEST(DepthSlopeDetector, ARoundPillarHasNoCorners) {
  Scene scene;
  scene.faces.push_back({{4.5, -6.0}, {4.5, 6.0}, 150.0});
  const Eigen::Vector2d centre(2.3, 0.3);
  constexpr int kSides = 32;
  const auto at = [&](int i) -> Eigen::Vector2d {
    const double angle = 2.0 * kPi * i / kSides;
    return centre + 0.2 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int i = kSides / 4; i < 3 * kSides / 4; ++i)  // the side one sees
    scene.faces.push_back({at(i), at(i + 1), 90.0});
  const Frame frame = render(scene, {}, 320, 240);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const auto found = DepthSlopeDetector().detect(withNoise(frame, 0.0, seed), EdgeLines{});
    EXPECT_TRUE(accepted(found, LandmarkKind::kDepthSlope).empty());
    EXPECT_FALSE(found.empty());  // seen, and refused
  }
}

TEST(DepthSlopeDetector, ACornerIsOnTheFrameThatStandsOutFromTheWall) {
  Scene scene;  // a doorway beside a wall, with a frame 8 cm wide that stands out by 2 cm
  scene.faces.push_back({{0.5, 1.0}, {1.8, 1.0}, 150.0});
  scene.faces.push_back({{1.8, 0.98}, {1.88, 0.98}, 60.0});
  scene.faces.push_back({{1.88, 0.98}, {1.88, 2.5}, 60.0});
  scene.faces.push_back({{1.0, 2.5}, {5.0, 2.5}, 150.0});
  const CameraPlace place{1.2, radians(10.0), 0.0, radians(25.0), {0.0, 0.0}};
  const auto found =
      DepthSlopeDetector().detect(withNoise(render(scene, place), 0.0, 3), EdgeLines{});
  const auto good = accepted(found, LandmarkKind::kDepthSlope);
  const Eigen::Vector2d frame(1.88, 0.98);
  const auto* corner = nearestBearing(good, bearingOf(frame));
  ASSERT_TRUE(corner);
  const auto& z = corner->measurement.z;
  const Eigen::Vector2d seen = z[1] * Eigen::Vector2d(std::cos(z[0]), std::sin(z[0]));
  EXPECT_LT((seen - frame).norm(), 0.015) << seen.transpose();
}

TEST(DepthSlopeDetector, NothingIsWhereACabinetEndsBeforeAWall) {
  // Its side and the wall would meet at (2.4, 0.35).
  const CameraPlace place{1.2, radians(5.0), 0.0, radians(10.0), {0.0, 0.0}};
  const auto refusal = [&](double gap_m) {
    Scene scene;
    scene.faces.push_back({{2.4, -6.0}, {2.4, 6.0}, 150.0});
    scene.faces.push_back({{1.6, 0.35}, {2.4 - gap_m, 0.35}, 100.0});
    scene.faces.push_back({{1.6, 0.35}, {1.6, 1.2}, 80.0});
    const auto found =
        DepthSlopeDetector().detect(withNoise(render(scene, place), 0.0, 3), EdgeLines{});
    const auto* corner = nearestBearing(found, bearingOf({2.4, 0.35}));
    return corner && std::abs(corner->measurement.z[0] - bearingOf({2.4, 0.35})) < 0.006
               ? corner->refusal
               : std::string("nothing there");
  };
  EXPECT_EQ(refusal(0.0), "");
  EXPECT_EQ(refusal(0.07), "a gap between the surfaces");
}

TEST(SlopePixels, TheRuleOfTheThesisMarksTheNearSideOfSteps) {
  Frame frame;
  frame.depth_m = cv::Mat(9, 40, CV_32FC1, cv::Scalar(3.0));
  frame.depth_m.colRange(10, 20).setTo(2.0F);
  frame.depth_m.colRange(20, 23).setTo(0.0F);  // not measured: the next one is the neighbour
  const SlopePixelOptions options;
  const auto found = findSlopePixels(frame, 100.0, options);
  ASSERT_EQ(found.size(), 2U * static_cast<std::size_t>(options.rows));
  EXPECT_EQ(found[0].u, 10);
  EXPECT_DOUBLE_EQ(found[0].weight, 1000.0);  // one metre in one column
  EXPECT_EQ(found[1].u, 19);
  EXPECT_DOUBLE_EQ(found[1].weight, 250.0);  // in four columns
  EXPECT_EQ(findSlopePixels(frame, 900.0, options).size(), static_cast<std::size_t>(options.rows));
  frame.depth_m.setTo(5.0F);
  frame.depth_m.colRange(10, 20).setTo(4.0F);
  EXPECT_TRUE(findSlopePixels(frame, 0.0, options).empty());  // beyond 3.81 m
}

TEST(SlopePixels, ColourCountsLessInTheDark) {
  Frame frame;
  frame.depth_m = cv::Mat(3, 40, CV_32FC1, cv::Scalar(2.01));
  frame.depth_m.colRange(10, 20).setTo(2.0F);
  frame.gray = cv::Mat(3, 40, CV_8UC1, cv::Scalar(200));
  frame.colour = cv::Mat(3, 40, CV_8UC3, cv::Scalar::all(220));
  frame.colour.colRange(10, 20).setTo(cv::Scalar::all(100));
  SlopePixelOptions options;
  options.rows = 1;
  options.colour_share = 0.8;
  const auto bright = findSlopePixels(frame, 0.0, options);
  frame.gray.setTo(40);
  const auto dark = findSlopePixels(frame, 0.0, options);
  ASSERT_EQ(bright.size(), 2U);
  ASSERT_EQ(dark.size(), 2U);
  const double alpha = 0.8 * 200.0 / 255.0;
  EXPECT_NEAR(bright[0].weight, alpha * 120.0 * std::sqrt(3.0) + (1.0 - alpha) * 10.0, 0.01);
  EXPECT_LT(dark[0].weight, 0.5 * bright[0].weight);
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
