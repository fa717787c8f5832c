// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "colonnade/frames/floor_plane.hpp"
#include "shared_data.hpp"
#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// One pair of a TUM folder whose file names sort by time; the floor in it tells the mounting.
std::optional<Frame> readFrame(const std::filesystem::path& colour,
                               const std::filesystem::path& depth, double units_per_metre,
                               const PinholeCamera& camera) {
  Frame frame;
  frame.colour = cv::imread(colour.string(), cv::IMREAD_COLOR);
  cv::cvtColor(frame.colour, frame.gray, cv::COLOR_BGR2GRAY);
  cv::imread(depth.string(), cv::IMREAD_UNCHANGED)
      .convertTo(frame.depth_m, CV_32F, 1.0 / units_per_metre);
  frame.camera = camera;
  const auto floor = fitFloorPlane(frame.depth_m, camera);
  if (!floor) return std::nullopt;
  frame.T_robot_camera = cameraAboveFloor(floor->normal_camera, floor->height_m);
  return frame;
}

TEST(Recordings, ACorridorGivesPillarsFloorEdgesOnBothSidesAndCorners) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  const auto colours = filesIn(folder / "rgb");
  const auto depths = filesIn(folder / "depth");
  ASSERT_EQ(colours.size(), depths.size());
  int frames = 0;
  int with_both_sides = 0;
  int corners = 0;
  int walls = 0;
  const auto backend = makeEdgeLineBackend(kDefaultBackend, {});
  DetectorBank bank;
  for (std::size_t i = 0; i < 80; i += 8) {  // walking along the corridor
    const auto frame =
        readFrame(colours[i], depths[i], 1000.0, {640, 480, 537.60, 539.03, 316.15, 245.52});
    ASSERT_TRUE(frame) << i;
    const auto all = bank.detect(*frame, backend->extract(frame->gray));
    ++frames;
    const auto pillars = accepted(all, LandmarkKind::kPillarEdge);
    EXPECT_GE(std::count_if(pillars.begin(), pillars.end(),
                            [](const Detection& d) { return d.measurement.hasRange(); }),
              2)
        << i;
    EXPECT_LE(pillars.size(), 40U) << i;
    bool left = false;
    bool right = false;
    for (const auto& edge : accepted(all, LandmarkKind::kFloorEdge)) {
      // The corridor is 2.2 m wide; door recesses are deeper.
      const double side_m = edge.measurement.z[1];
      left |= std::abs(wrapAngle(edge.measurement.z[0] - kPi / 2)) < radians(15) && side_m > 0.6 &&
              side_m < 1.8;
      right |= std::abs(wrapAngle(edge.measurement.z[0] + kPi / 2)) < radians(15) && side_m > 0.6 &&
               side_m < 1.8;
    }
    with_both_sides += left && right;
    corners += static_cast<int>(accepted(all, LandmarkKind::kDepthSlope).size());
    walls += static_cast<int>(bank.wallDirections().size());
  }
  EXPECT_GE(with_both_sides, frames - 2);
  EXPECT_GE(corners, 5);
  EXPECT_GE(walls, 2 * frames);
}

TEST(Recordings, BareWallsGiveFloorEdgesAndCornersInEveryFrame) {
  COLONNADE_REQUIRE_RECORDING(folder, "tum_fr3_structure_notexture_far");
  const auto colours = filesIn(folder / "rgb");
  const auto depths = filesIn(folder / "depth");
  ASSERT_EQ(colours.size(), depths.size());
  for (std::size_t i = 0; i < colours.size(); i += 31) {
    const auto frame =
        readFrame(colours[i], depths[i], 5000.0, {640, 480, 535.4, 539.2, 320.1, 247.6});
    ASSERT_TRUE(frame) << i;
    const auto all = detectAll(*frame);
    EXPECT_GE(accepted(all, LandmarkKind::kFloorEdge).size(), 2U) << i;
    EXPECT_GE(accepted(all, LandmarkKind::kDepthSlope).size(), 2U) << i;
    EXPECT_LE(accepted(all, LandmarkKind::kDepthSlope).size(), 6U) << i;
  }
}

/// Distance of every pixel from the border of the mask within the picture, px.
cv::Mat distanceFromBorder(const cv::Mat& mask) {
  cv::Mat floor = mask > 127, eroded;
  cv::erode(floor, eroded, cv::Mat(), {-1, -1}, 1, cv::BORDER_REPLICATE);
  cv::Mat distance;
  cv::distanceTransform((floor & ~eroded) == 0, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

/// Two photographs without depth or calibration (a level camera of usual field of view is assumed)
/// whose floor was masked by hand. The mask of the first ends some 13 px before the skirting boards
/// on which the detected edges lie; that of the second is ragged by a few pixels.
TEST(Recordings, FloorEdgesLieOnTheBorderOfFloorMasks) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_images");
  const std::pair<std::string, float> kPictures[] = {{"0050", 16.0F}, {"0115", 5.0F}};
  for (const auto& [number, within_px] : kPictures) {
    Frame frame;
    frame.colour = cv::imread((folder / ("rgb_" + number + ".png")).string(), cv::IMREAD_COLOR);
    ASSERT_FALSE(frame.colour.empty());
    cv::cvtColor(frame.colour, frame.gray, cv::COLOR_BGR2GRAY);
    const int width = frame.gray.cols, height = frame.gray.rows;
    frame.camera = {width, height, 525.0, 525.0, 0.5 * (width - 1), 0.5 * (height - 1)};
    frame.T_robot_camera = cameraAboveFloor(Eigen::Vector3d(0.0, -1.0, 0.0), 1.0);
    const cv::Mat mask =
        cv::imread((folder / ("label_" + number + ".png")).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(mask.size(), frame.gray.size());
    const cv::Mat distance = distanceFromBorder(mask);
    const auto backend = makeEdgeLineBackend(kDefaultBackend, {});
    const auto edges = accepted(DetectorBank().detect(frame, backend->extract(frame.gray)),
                                LandmarkKind::kFloorEdge);
    EXPECT_GE(edges.size(), 2U) << number;
    std::vector<float> off_px;
    for (const auto& edge : edges)
      for (int i = 0; i <= 50; ++i) {
        const Eigen::Vector2d p = edge.a_px + (edge.b_px - edge.a_px) * i / 50.0;
        const cv::Point pixel(static_cast<int>(std::lround(p.x())),
                              static_cast<int>(std::lround(p.y())));
        if (cv::Rect(0, 0, width, height).contains(pixel))
          off_px.push_back(distance.at<float>(pixel));
      }
    ASSERT_FALSE(off_px.empty());
    std::sort(off_px.begin(), off_px.end());
    const float median_px = off_px[off_px.size() / 2], most_px = off_px[off_px.size() * 9 / 10];
    RecordProperty("median_px_" + number, std::to_string(median_px));
    std::printf("%s: %zu edges, %.1f px from the mask's border (median), %.1f px (90 %%)\n",
                number.c_str(), edges.size(), static_cast<double>(median_px),
                static_cast<double>(most_px));
    EXPECT_LT(median_px, within_px) << number;
    EXPECT_LT(most_px, within_px + 5.0F) << number;
  }
}

}  // namespace
}  // namespace colonnade::testing
