// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/detector_bank.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "colonnade/base/config.hpp"
#include "colonnade/detectors/draw_detections.hpp"
#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

Scene room() {
  Scene scene;
  scene.faces.push_back({{3.0, -1.2}, {3.0, 1.5}, 150.0});
  scene.faces.push_back({{-1.0, -1.2}, {3.0, -1.2}, 120.0});
  scene.faces.push_back({{2.0, 0.1}, {2.0, 0.5}, 60.0});
  return scene;
}

const CameraPlace kPlace{1.2, radians(10.0), 0.0, 0.0, {0.0, 0.0}};

TEST(DetectorBank, FindsAllKindsInOneRoom) {
  const Frame frame = render(room(), kPlace);
  const auto edges = makeEdgeLineBackend(kDefaultBackend, {})->extract(frame.gray);
  DetectorBank bank;
  const auto all = bank.detect(frame, edges);
  EXPECT_GE(accepted(all, LandmarkKind::kPillarEdge).size(), 2U);
  EXPECT_GE(accepted(all, LandmarkKind::kFloorEdge).size(), 2U);
  EXPECT_GE(accepted(all, LandmarkKind::kDepthSlope).size(), 1U);
  EXPECT_GE(bank.wallDirections().size(), 2U);
  const cv::Mat picture = drawDetections(frame, edges, all);
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_GE(picture.rows, frame.gray.rows);
}

TEST(DetectorBank, LeavesOutTheKindsThatAreSwitchedOff) {
  const Frame frame = render(room(), kPlace);
  const auto edges = makeEdgeLineBackend(kDefaultBackend, {})->extract(frame.gray);
  const auto kinds = [&](const DetectorOptions& options) {
    std::set<LandmarkKind> seen;
    for (const auto& detection : DetectorBank(options).detect(frame, edges))
      seen.insert(detection.kind());
    return seen;
  };
  using enum LandmarkKind;
  DetectorOptions options;
  options.pillars.enabled = false;
  EXPECT_EQ(kinds(options), (std::set{kFloorEdge, kDepthSlope}));
  options.floor_edges.enabled = false;
  EXPECT_EQ(kinds(options), (std::set{kDepthSlope}));
  options.depth_slopes.enabled = false;
  EXPECT_TRUE(kinds(options).empty());
}

TEST(DetectorBank, SurvivesDamagedFrames) {
  const auto backend = makeEdgeLineBackend(kDefaultBackend, {});
  DetectorBank bank;
  const auto run = [&](const Frame& frame) {
    const auto edges = backend->extract(frame.gray);
    const auto all = bank.detect(frame, edges);
    for (const auto& detection : all) {
      EXPECT_TRUE(detection.measurement.z.allFinite());
      EXPECT_TRUE(detection.measurement.R.allFinite());
    }
    drawDetections(frame, edges, all);
    return all;
  };
  const Frame good = render(room(), kPlace);

  EXPECT_TRUE(run(Frame{}).empty());

  Frame uncalibrated = good;
  uncalibrated.camera.fx_px = 0.0;
  EXPECT_TRUE(run(uncalibrated).empty());

  for (const float value : {0.0F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -1.0F, 1e30F}) {
    Frame frame = good;
    frame.depth_m = cv::Mat(good.depth_m.size(), CV_32FC1, cv::Scalar(static_cast<double>(value)));
    const auto all = run(frame);
    EXPECT_TRUE(accepted(all, LandmarkKind::kDepthSlope).empty());
    for (const auto& pillar : accepted(all, LandmarkKind::kPillarEdge)) {
      EXPECT_FALSE(pillar.measurement.hasRange());
    }
  }

  Frame tiny = good;
  tiny.gray = cv::Mat(1, 1, CV_8UC1, cv::Scalar(7));
  tiny.depth_m = cv::Mat(1, 1, CV_32FC1, cv::Scalar(1.0));
  tiny.camera.width_px = tiny.camera.height_px = 1;
  EXPECT_TRUE(run(tiny).empty());

  Frame other_size = good;
  other_size.depth_m = cv::Mat(10, 10, CV_32FC1, cv::Scalar(1.0));
  run(other_size);

  Frame no_image = good;
  no_image.gray.release();
  for (const auto& detection : run(no_image)) {
    EXPECT_EQ(detection.kind(), LandmarkKind::kDepthSlope);
  }

  Frame on_the_floor = good;
  on_the_floor.T_robot_camera.translation().z() = 0.0;
  run(on_the_floor);

  Frame looking_down = good;
  looking_down.T_robot_camera = mounting({1.2, radians(90.0), 0.0, 0.0, {0.0, 0.0}});
  run(looking_down);
}

TEST(DetectorBank, IsRepeatable) {
  const Frame frame = withNoise(render(room(), kPlace), 3.0, 9);
  const auto first = detectAll(frame);
  const auto second = detectAll(frame);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].measurement.z, second[i].measurement.z);
    EXPECT_EQ(first[i].measurement.R, second[i].measurement.R);
    EXPECT_EQ(first[i].refusal, second[i].refusal);
  }
}

TEST(DetectorOptions, AreReadFromTheirSections) {
  Config config = Config::fromText(
      "[Pillars]\nvertical_tolerance_deg = 7\n[DepthSlopes]\nmax_range_m = 4.5\n", "test.ini");
  DetectorOptions options;
  options.each([&](auto& section) { config.read(section); });
  config.requireAllKnown();
  EXPECT_DOUBLE_EQ(options.pillars.vertical_tolerance, radians(7.0));
  EXPECT_DOUBLE_EQ(options.depth_slopes.max_range_m, 4.5);
}

}  // namespace
}  // namespace colonnade::testing
