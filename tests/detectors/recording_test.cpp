// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
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

}  // namespace
}  // namespace colonnade::testing
