// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/fixed_stage.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>

#include "colonnade/base/error.hpp"
#include "colonnade/edges/fixed_lines.hpp"
#include "fixed_definition.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

void expectAsDefined(const cv::Mat& gray, const FixedShape& shape, const FixedParameters& p) {
  const testing::FixedDefinition defined(gray, shape, p);
  FixedStage stage(shape);
  const auto found = stage.process(gray, p);
  ASSERT_EQ(found.edges.size(), gray.size());
  for (int v = 0; v < gray.rows; ++v) {
    for (int u = 0; u < gray.cols; ++u) {
      ASSERT_EQ(found.edges.at<unsigned char>(v, u), defined.edge(u, v)) << u << ", " << v;
    }
  }
  EXPECT_TRUE(found.lines == defined.lines());
}

/// Noise of a few scales, so that all thresholds, directions and chains occur.
cv::Mat randomImage(cv::Size size, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat image(size, CV_8UC1);
  const int coarse = 1 + static_cast<int>(random() % 6);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const bool copy = u % coarse != 0;
      image.at<unsigned char>(v, u) =
          copy ? image.at<unsigned char>(v, u - 1) : static_cast<unsigned char>(random());
    }
  }
  return image;
}

TEST(FixedStage, FollowsTheDefinitionOnRandomImages) {
  const cv::Size sizes[] = {{1, 1}, {2, 3}, {1, 40}, {63, 5}, {64, 20}, {65, 31}, {130, 47}};
  unsigned seed = 1;
  for (const auto& size : sizes) {
    for (int passes = 0; passes < 4; ++passes) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", " +
                   std::to_string(passes) + " passes");
      FixedParameters p;
      p.low = 20 + 30 * passes;
      p.high = 150 + 60 * passes;
      p.vertical_votes = 4;
      p.inclined_votes = 5;
      p.first_row = size.height / 3;
      expectAsDefined(randomImage(size, ++seed), {runShape().angles_deg, passes}, p);
    }
  }
}

TEST(FixedStage, FollowsTheDefinitionOnARealCorridor) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  cv::Mat image = cv::imread((folder / "rgb/0000000005.400000.jpg").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(image.empty());
  cv::resize(image, image, {320, 240}, 0, 0, cv::INTER_AREA);
  const FixedShape shape = runShape();
  const auto p = runParameters(shape, {}, {}, image.cols, image.rows);
  expectAsDefined(image, shape, p);
  EXPECT_GE(FixedStage(shape).process(image, p).lines.size(), 20U);
}

TEST(FixedStage, HysteresisFollowsAnEdgeDownAndToTheRight) {
  // A vertical step that fades to the bottom: strong above, weak below.
  cv::Mat image(60, 40, CV_8UC1, cv::Scalar(100));
  for (int v = 0; v < 60; ++v) {
    image(cv::Rect(20, v, 20, 1)) = cv::Scalar(170 - v);
  }
  FixedParameters p;
  p.low = 20;
  p.high = 80;
  const auto lengthOf = [&](const cv::Mat& gray, int passes) {
    return cv::countNonZero(FixedStage({{0}, passes}).process(gray, p).edges.colRange(0, 20));
  };
  EXPECT_LT(lengthOf(image, 0), 40);
  EXPECT_GE(lengthOf(image, 1), 59);
  cv::flip(image, image, 0);  // now it fades to the top: one row up in each pass
  EXPECT_EQ(lengthOf(image, 5) - lengthOf(image, 1), 4);
}

TEST(FixedStage, ReportsALineOnceWhereNeighbouringAnglesFireTogether) {
  // Steps at 0, 1 and 2 degrees and one between two angles; the set holds all of them.
  const FixedShape shape{{-2, -1, 0, 1, 2, 3}, 0};
  for (const double theta : {0.0, 1.0, 2.0, 0.5, 1.5, -0.5}) {
    cv::Mat image(120, 120, CV_8UC1);
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 120; ++u) {
        const double beyond =
            (u - 60) * std::cos(radians(theta)) + (v - 60) * std::sin(radians(theta)) - 7.3;
        image.at<unsigned char>(v, u) =
            static_cast<unsigned char>(60 + 120 * std::clamp(beyond + 0.5, 0.0, 1.0));
      }
    }
    FixedParameters p;
    p.vertical_votes = 40;
    const auto lines = FixedStage(shape).process(image, p).lines;
    ASSERT_EQ(lines.size(), 1U) << theta;
    EXPECT_NEAR(lines[0].theta_deg, theta, 1.0);
    EXPECT_NEAR(lines[0].rho, 7, 1);
  }
}

TEST(FixedStage, RefusesAnglesOutOfOrder) {
  EXPECT_THROW(FixedStage({{0, 0}, 0}), Error);
  EXPECT_THROW(FixedStage({{3, 1}, 0}), Error);
  EXPECT_THROW(FixedStage({{-91}, 0}), Error);
  EXPECT_THROW(FixedStage({{90}, 0}), Error);
}

TEST(Generated, FilesAgreeWithTheirSource) {
  const std::string command =
      "python3 " + (testing::sourceFolder() / "hdl/generate.py").string() + " --check";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace colonnade
