// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/frame_check.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

Frame room() {
  Scene scene;
  scene.faces.push_back({{3.0, -1.2}, {3.0, 1.5}, 150.0});
  scene.faces.push_back({{-1.0, -1.2}, {3.0, -1.2}, 120.0});
  scene.faces.push_back({{2.0, 0.1}, {2.0, 0.5}, 60.0});
  return render(scene, {1.2, radians(10.0), 0.0, 0.0, {0.0, 0.0}});
}

struct Outcome {
  std::size_t accepted = 0;
  std::vector<std::string> lacking;
};

Outcome outcomeOf(const Frame& frame, const std::string& backend) {
  EdgeLines edges;
  if (frame.gray.empty() || frame.gray.type() == CV_8UC1)
    edges = makeEdgeLineBackend(backend, {})->extract(frame.gray);
  DetectorBank bank;
  Outcome outcome;
  for (const Detection& detection : bank.detect(frame, edges))
    outcome.accepted += detection.accepted() ? 1 : 0;
  outcome.lacking = bank.lacking();
  return outcome;
}

TEST(FrameCheck, TheLastPixelLookedAtMayTell) {
  Frame frame;
  frame.gray = cv::Mat(480, 640, CV_8UC1, cv::Scalar(100));
  frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(0));
  frame.gray.at<std::uint8_t>(472, 632) = 103;
  for (int i = 0; i < 23; ++i) frame.depth_m.at<float>(472, 632 - 8 * i) = 2.0F;
  EXPECT_FALSE(checkFrame(frame, {}).image_usable);
  EXPECT_FALSE(checkFrame(frame, {}).depth_usable);  // 23 of 4800 are less than 0.5 %
  frame.gray.at<std::uint8_t>(472, 632) = 104;
  frame.depth_m.at<float>(464, 0) = 2.0F;
  EXPECT_TRUE(checkFrame(frame, {}).image_usable);
  EXPECT_TRUE(checkFrame(frame, {}).depth_usable);
}

class StrangeFrames : public ::testing::TestWithParam<const char*> {};

TEST_P(StrangeFrames, LackNothingWhenSound) {
  Frame frame = room();
  EXPECT_TRUE(outcomeOf(frame, GetParam()).lacking.empty());
  frame.depth_m.release();  // a camera without depth
  EXPECT_TRUE(outcomeOf(frame, GetParam()).lacking.empty());
  EXPECT_GT(outcomeOf(frame, GetParam()).accepted, 0U);
}

TEST_P(StrangeFrames, OfTheImageGiveNoLandmarkAndAReason) {
  cv::RNG random(7);
  cv::Mat uniform(480, 640, CV_8UC1), normal(480, 640, CV_8UC1);
  random.fill(uniform, cv::RNG::UNIFORM, 0, 256);
  random.fill(normal, cv::RNG::NORMAL, 128, 12);
  const std::pair<cv::Mat, const char*> cases[] = {
      {cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)), "the image is too small"},
      {cv::Mat(480, 640, CV_16UC1, cv::Scalar(900)), "the image is not 8-bit gray"},
      {cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)), "the image has no contrast"},
      {cv::Mat(480, 640, CV_8UC1, cv::Scalar(255)), "the image has no contrast"},
      {uniform, "the image is noise"},
      {normal, "the image shows no straight edge"}};
  for (const auto& [image, reason] : cases) {
    Frame frame = room();
    frame.depth_m.release();
    frame.colour.release();
    frame.gray = image;
    const Outcome outcome = outcomeOf(frame, GetParam());
    EXPECT_EQ(outcome.accepted, 0U) << reason;
    EXPECT_EQ(outcome.lacking, std::vector<std::string>{reason});
  }
}

TEST_P(StrangeFrames, OfTheDepthGiveNoRangeAndAReason) {
  for (const float value : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    Frame frame = room();
    frame.depth_m.setTo(value);
    EXPECT_EQ(outcomeOf(frame, GetParam()).lacking,
              std::vector<std::string>{"the depth holds no values"});
    for (const Detection& detection :
         DetectorBank().detect(frame, makeEdgeLineBackend(GetParam(), {})->extract(frame.gray))) {
      EXPECT_NE(detection.kind(), LandmarkKind::kDepthSlope);
      if (detection.kind() == LandmarkKind::kPillarEdge) {
        EXPECT_FALSE(detection.accepted() && detection.measurement.hasRange());
      }
    }
    frame.gray = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
    const Outcome dark = outcomeOf(frame, GetParam());
    EXPECT_EQ(dark.accepted, 0U);
    EXPECT_EQ(dark.lacking.size(), 2U);
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, StrangeFrames, ::testing::Values("opencv", "fixed"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace colonnade::testing
