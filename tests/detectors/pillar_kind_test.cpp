// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/detectors/pillar_pairs.hpp"
#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

const CameraPlace kLevel{0.9, radians(12.0), 0.0, 0.0, {0.0, 0.0}};

Face wall(double gray = 150.0) { return {{4.0, -5.0}, {4.0, 5.0}, gray}; }

bool seesEdgeAt(const Detections& all, const Eigen::Vector2d& p_robot) {
  const auto pillars = accepted(all, LandmarkKind::kPillarEdge);
  const auto* nearest = nearestBearing(pillars, bearingOf(p_robot));
  return nearest && std::abs(nearest->measurement.z[0] - bearingOf(p_robot)) < 0.01;
}

bool isRefused(const Detections& all, const std::string& reason) {
  return std::any_of(all.begin(), all.end(),
                     [&](const Detection& d) { return d.refusal == reason; });
}

TEST(PillarKind, BoardsEndAboveTheFloor) {
  Scene scene{
      {wall(), {{3.98, 0.2}, {3.98, 1.2}, 60.0, 0.8, 1.5}, {{3.5, -1.2}, {3.5, -0.8}, 70.0}}, {}};
  const auto all = detectAll(withNoise(render(scene, kLevel), 2.0, 1));
  EXPECT_FALSE(seesEdgeAt(all, {3.98, 0.2}));
  EXPECT_FALSE(seesEdgeAt(all, {3.98, 1.2}));
  EXPECT_TRUE(isRefused(all, "ends above the floor"));
  EXPECT_TRUE(seesEdgeAt(all, {3.5, -1.2}));  // the pillar beside it stands
  EXPECT_TRUE(seesEdgeAt(all, {3.5, -0.8}));
}

TEST(PillarKind, FurnitureIsTooLow) {
  Scene scene{{wall(), {{3.0, 0.2}, {3.0, 0.9}, 60.0, 0.0, 0.8}, {{3.0, -1.0}, {3.0, -0.6}, 70.0}},
              {}};
  const auto all = detectAll(withNoise(render(scene, kLevel), 2.0, 2));
  EXPECT_FALSE(seesEdgeAt(all, {3.0, 0.2}));
  EXPECT_FALSE(seesEdgeAt(all, {3.0, 0.9}));
  EXPECT_TRUE(isRefused(all, "too low for a part of the building"));
  EXPECT_TRUE(seesEdgeAt(all, {3.0, -1.0}));
  // Without depth the horizon tells.
  Frame blind = withNoise(render(scene, kLevel), 2.0, 2);
  blind.depth_m.release();
  EXPECT_FALSE(seesEdgeAt(detectAll(blind), {3.0, 0.2}));
  EXPECT_TRUE(seesEdgeAt(detectAll(blind), {3.0, -1.0}));
}

TEST(PillarKind, ADepthJumpThatEndsBelowTheHeadIsFurniture) {
  // A cabinet before a wall that has its shade in the lower part: the edge is seen above, where a
  // notice hangs behind it, and depth jumps up to the cabinet's top.
  Scene scene{{wall(),
               {{3.0, 0.2}, {3.0, 0.9}, 150.0, 0.0, 1.25},
               {{3.98, 0.8}, {3.98, 1.7}, 60.0, 0.7, 1.2}},
              {}};
  const CameraPlace high{0.9, radians(4.0), 0.0, 0.0, {0.0, 0.0}};
  EXPECT_FALSE(seesEdgeAt(detectAll(withNoise(render(scene, high), 2.0, 7)), {3.0, 0.9}));
}

TEST(PillarKind, PanelsOneAboveTheOtherAreNoEdge) {
  // Grooves of a door, 3 cm wide: one that reaches to the floor is a joint, two with a rail between
  // them are panels.
  const auto grooves = [](double low, double high) {
    return Face{{3.99, 0.0}, {3.99, 0.03}, 60.0, low, high};
  };
  Scene joint{{wall(), grooves(0.0, 2.4)}, {}};
  Scene panels{{wall(), grooves(0.12, 0.7), grooves(0.95, 2.4)}, {}};
  const auto edgesAt = [](const Detections& all) {
    int edges = 0;
    for (const auto& d : accepted(all, LandmarkKind::kPillarEdge))
      edges += std::abs(d.measurement.z[0] - bearingOf({3.99, 0.015})) < 0.01 && !d.on_surface;
    return edges;
  };
  EXPECT_GT(edgesAt(detectAll(withNoise(render(joint, kLevel), 2.0, 8))), 0);
  EXPECT_EQ(edgesAt(detectAll(withNoise(render(panels, kLevel), 2.0, 8))), 0);
}

TEST(PillarKind, PaintThatEndsAboveTheFloorLiesOnASurface) {
  Scene scene{{wall(), {{3.99, 0.0}, {3.99, 0.02}, 60.0, 0.0, 2.4}}, {}};
  Frame frame = withNoise(render(scene, kLevel), 2.0, 9);
  frame.depth_m.release();  // whether it reaches the floor is not known then
  const auto pillars = accepted(detectAll(frame), LandmarkKind::kPillarEdge);
  ASSERT_FALSE(pillars.empty());
  for (const auto& pillar : pillars) EXPECT_TRUE(pillar.on_surface);
}

TEST(PillarKind, WhereDepthFailsOnOneSideTheOtherOneTells) {
  // What lies behind the pillar and the board is out of reach.
  Scene scene{{{{9.0, -9.0}, {9.0, 9.0}, 150.0},
               {{3.5, -0.8}, {3.5, -0.4}, 70.0},
               {{3.5, 0.2}, {3.5, 0.9}, 70.0, 0.7, 1.4}},
              {}};
  Frame frame = withNoise(render(scene, kLevel), 2.0, 10);
  frame.depth_m.setTo(0.0F, frame.depth_m > 6.0F);
  const auto all = detectAll(frame);
  EXPECT_TRUE(seesEdgeAt(all, {3.5, -0.4}));
  EXPECT_FALSE(seesEdgeAt(all, {3.5, 0.2}));
  EXPECT_TRUE(isRefused(all, "ends above the floor"));
}

TEST(PillarKind, AnEdgeWithoutDepthThatEndsOnAWallIsRefused) {
  // A mirror: no depth on it, wall below it.
  Scene scene{{wall(), {{3.999, -0.6}, {3.999, 0.6}, 60.0, 0.5, 2.5}}, {}};
  Frame frame = withNoise(render(scene, kLevel), 2.0, 5);
  EXPECT_FALSE(seesEdgeAt(detectAll(frame), {3.999, 0.6}));
  for (int v = 0; v < frame.gray.rows; ++v)
    for (int u = 0; u < frame.gray.cols; ++u)
      if (v < frame.gray.rows / 2 && u > 20) frame.depth_m.at<float>(v, u) = 0.0F;
  EXPECT_FALSE(seesEdgeAt(detectAll(frame), {3.999, 0.6}));
}

TEST(PillarKind, TwoEdgesAloneMayLeanWithTheCamera) {
  // The camera has rolled by 2.5 degrees and nobody knows.
  Scene scene{{wall(), {{3.5, -0.4}, {3.5, 0.4}, 70.0}}, {}};
  CameraPlace rolled = kLevel;
  rolled.roll = radians(2.5);
  Frame frame = withNoise(render(scene, rolled), 2.0, 6);
  frame.T_robot_camera = render(scene, kLevel).T_robot_camera;
  const auto all = detectAll(frame);
  EXPECT_FALSE(isRefused(all, "leans over"));
  EXPECT_GE(accepted(all, LandmarkKind::kPillarEdge).size(), 2U);
}

TEST(PillarKind, AnEdgeWhoseFootIsHiddenStays) {
  // A box before the foot of the pillar.
  Scene scene{{wall(), {{3.5, -0.4}, {3.5, 0.4}, 70.0}, {{2.0, -0.8}, {2.0, 0.8}, 110.0, 0.0, 0.5}},
              {}};
  const auto all = detectAll(withNoise(render(scene, kLevel), 2.0, 3));
  EXPECT_TRUE(seesEdgeAt(all, {3.5, -0.4}));
  EXPECT_TRUE(seesEdgeAt(all, {3.5, 0.4}));
}

/// A pilaster whose face is darker than its flank by so many gray levels in a row.
Frame pilaster(const std::function<double(int)>& contrast_at) {
  constexpr double kFlank = 251.0;
  Scene scene{{wall(150.0), {{3.5, -0.4}, {3.5, 0.0}, 150.0}, {{3.5, 0.0}, {4.0, 0.3}, kFlank}},
              {}};
  scene.floor_gray = 150.0;
  Frame frame = render(scene, kLevel);
  for (int v = 0; v < frame.gray.rows; ++v)
    for (int u = 0; u < frame.gray.cols; ++u) {
      auto& gray = frame.gray.at<std::uint8_t>(v, u);
      gray = cv::saturate_cast<std::uint8_t>(150.0 +
                                             (gray - 150.0) / (kFlank - 150.0) * contrast_at(v));
    }
  return withNoise(frame, 2.0, 11);
}

TEST(PillarKind, AnEdgeWhoseContrastFadesAwayDoesNotEndThere) {
  const Eigen::Vector2d ridge(3.5, 0.0);
  const auto fading = [](int v) { return std::max(0.0, 44.0 - 0.18 * v); };
  EXPECT_TRUE(seesEdgeAt(detectAll(pilaster(fading)), ridge));
  // Faint for longer than it is strong, and seen over 0.9 m.
  const auto faint = [](int v) { return v < 165 ? std::max(17.0, 60.0 - 0.45 * v) : 0.0; };
  EXPECT_TRUE(seesEdgeAt(detectAll(pilaster(faint)), ridge));
  const auto ending = [](int v) { return v < 160 ? 30.0 : 0.0; };
  EXPECT_FALSE(seesEdgeAt(detectAll(pilaster(ending)), ridge));
}

TEST(PillarKind, TwoEdgesSideBySideAreTwo) {
  // A narrow reveal beside a pillar: both steps rise the same way, 3.5 px apart.
  Scene scene{{wall(170.0), {{3.5, -0.4}, {3.5, 0.0}, 60.0}, {{3.5, 0.0}, {3.5, 0.023}, 115.0}},
              {}};
  const auto all = detectAll(withNoise(render(scene, kLevel), 2.0, 12));
  int edges = 0;
  for (const auto& d : accepted(all, LandmarkKind::kPillarEdge))
    edges += std::abs(d.measurement.z[0] - bearingOf({3.5, 0.0115})) < 0.006;
  EXPECT_EQ(edges, 2);
}

TEST(PillarKind, FaintEdgesAreFoundInNoise) {
  Scene scene{{wall(150.0), {{3.5, -0.4}, {3.5, 0.4}, 134.0}}, {}};  // 16 gray levels
  const Frame frame = withNoise(render(scene, kLevel), 4.0, 4);
  const auto all = detectAll(frame);
  EXPECT_TRUE(seesEdgeAt(all, {3.5, -0.4}));
  EXPECT_TRUE(seesEdgeAt(all, {3.5, 0.4}));
}

TEST(PillarKind, AGentleShadeIsNoEdge) {
  Frame frame = render(Scene{{wall()}, {}}, {0.9, 0.0, 0.0, 0.0, {0.0, 0.0}});
  for (int row = 0; row < frame.gray.rows; ++row)
    for (int u = 0; u < frame.gray.cols; ++u)  // 40 gray levels over 16 pixels
      frame.gray.at<std::uint8_t>(row, u) =
          static_cast<std::uint8_t>(100 + 40 * std::clamp(u - 312, 0, 16) / 16);
  EXPECT_TRUE(accepted(detectAll(frame), LandmarkKind::kPillarEdge).empty());
}

Detection edgeAt(double column, const Eigen::Vector3f& left, const Eigen::Vector3f& right) {
  Detection edge;
  edge.measurement.z = Eigen::VectorXd::Zero(1);
  edge.measurement.R = Eigen::MatrixXd::Identity(1, 1);
  edge.a_px = {column, 40.0};
  edge.b_px = {column, 400.0};
  edge.appearance.left = left;
  edge.appearance.right = right;
  edge.appearance.gradient_sign = right.sum() > left.sum() ? 1 : -1;
  return edge;
}

TEST(KnownShade, TheLargestVirtualWidthIsThePillars) {
  // Thesis 2015, section 2.4: columns 309, 349 and 351 give 40, 42 and 2; it is 42.
  const Eigen::Vector3f orange(30, 110, 230), background(90, 90, 90);
  ShadeOptions shade{.space = "rgb",
                     .first_low = 180,
                     .first_high = 255,
                     .second_low = 60,
                     .second_high = 160,
                     .third_low = 0,
                     .third_high = 80};
  Detections edges{edgeAt(349, orange, background), edgeAt(309, background, orange),
                   edgeAt(351, orange, background), edgeAt(500, background, 2 * background),
                   edgeAt(330, orange, 0.9F * orange)};
  refuseFalseEdges(edges, shade);
  pairPillars(edges, PillarOptions{}, shade);
  EXPECT_EQ("false edge inside a pillar", edges[0].refusal);
  EXPECT_EQ("not of the known shade", edges[3].refusal);
  EXPECT_EQ("inside the known shade", edges[4].refusal);
  ASSERT_TRUE(edges[1].partner);
  EXPECT_EQ(2U, *edges[1].partner);
  Detections unknown{edgeAt(349, orange, background), edgeAt(351, orange, background)};
  refuseFalseEdges(unknown, ShadeOptions{});
  EXPECT_TRUE(unknown[0].accepted() && unknown[1].accepted());
}

TEST(KnownShade, IsLearnedFromARectangle) {
  cv::Mat picture(100, 100, CV_8UC3, cv::Scalar(120, 120, 120));
  picture(cv::Rect(40, 0, 20, 100)).setTo(cv::Scalar(20, 30, 200));  // red: hue around 0
  cv::Mat noise(picture.size(), CV_8UC3);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 12);
  picture += noise;
  for (const char* space : {"hsv", "rgb"}) {
    const auto shade = learnShade(picture, {42, 10, 16, 80}, space);
    EXPECT_TRUE(hasShade({25, 35, 205}, shade)) << space;
    EXPECT_TRUE(hasShade({35, 25, 195}, shade)) << space;  // the other side of hue 0
    EXPECT_FALSE(hasShade({120, 120, 120}, shade)) << space;
    EXPECT_FALSE(hasShade({200, 30, 20}, shade)) << space;
  }
  EXPECT_THROW(learnShade(picture, {90, 10, 16, 80}), Error);
  EXPECT_THROW(learnShade(picture, {5, 5, 0, 5}), Error);
  EXPECT_THROW(learnShade(cv::Mat(100, 100, CV_8UC1), {5, 5, 5, 5}), Error);
}

TEST(KnownShade, LeavesOnlyPillarsOfIt) {
  Scene scene{{wall(), {{3.5, 0.4}, {3.5, 0.8}, 60.0}, {{3.5, -0.8}, {3.5, -0.4}, 230.0}}, {}};
  const Frame frame = render(scene, kLevel);
  DetectorOptions options;
  options.shade = {.space = "rgb",
                   .first_low = 40,
                   .first_high = 80,
                   .second_low = 40,
                   .second_high = 80,
                   .third_low = 40,
                   .third_high = 80};
  const auto all = detectAll(frame, options);
  EXPECT_TRUE(seesEdgeAt(all, {3.5, 0.4}));
  EXPECT_TRUE(seesEdgeAt(all, {3.5, 0.8}));
  EXPECT_FALSE(seesEdgeAt(all, {3.5, -0.4}));
}

}  // namespace
}  // namespace colonnade::testing
