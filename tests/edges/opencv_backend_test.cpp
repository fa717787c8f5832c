// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

EdgeLines extract(const cv::Mat& gray, const EdgeOptions& options = {}) {
  return makeEdgeLineBackend("opencv", options)->extract(gray);
}

/// Dark where u cos(theta) + v sin(theta) < rho, bright beyond, with a soft edge of one pixel.
cv::Mat halfPlane(double theta_deg, double rho_px, cv::Size size = {320, 240}) {
  cv::Mat image(size, CV_8UC1);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double beyond =
          u * std::cos(radians(theta_deg)) + v * std::sin(radians(theta_deg)) - rho_px;
      image.at<unsigned char>(v, u) =
          static_cast<unsigned char>(60.0 + 120.0 * std::clamp(beyond + 0.5, 0.0, 1.0));
    }
  }
  return image;
}

TEST(OpencvBackend, FindsALineWhereItIs) {
  const struct {
    double theta_deg, rho_px;
    LineClass line_class;
  } cases[] = {{0, 100, LineClass::kVertical},    {8, 150, LineClass::kVertical},
               {172, -120, LineClass::kVertical}, {45, 200, LineClass::kInclined},
               {90, 120, LineClass::kInclined},   {135, 30, LineClass::kInclined}};
  for (const auto& c : cases) {
    const auto lines = extract(halfPlane(c.theta_deg, c.rho_px)).lines;
    ASSERT_FALSE(lines.empty()) << c.theta_deg;
    EXPECT_NEAR(lines[0].theta_index, c.theta_deg, 1) << c.theta_deg;
    EXPECT_NEAR(lines[0].rho_bin, c.rho_px, 2) << c.theta_deg;
    EXPECT_EQ(lines[0].line_class, c.line_class) << c.theta_deg;
    EXPECT_GE(lines[0].votes, 50) << c.theta_deg;
  }
}

TEST(OpencvBackend, GivesOneLineWhereTheAngleWraps) {
  // Half a degree off the vertical: the peak lies between 179 and 0 degrees.
  int there = 0;
  for (const auto& line : extract(halfPlane(179.5, -160.0)).lines) {
    const bool wrapped = line.theta_index > 90;
    const int turn = wrapped ? line.theta_index - 180 : line.theta_index;
    const int rho = wrapped ? -line.rho_bin : line.rho_bin;
    if (std::abs(turn) <= 1 && std::abs(rho - 160) <= 2) ++there;
  }
  EXPECT_EQ(there, 1);
}

TEST(OpencvBackend, EncodesTheDirectionOfTheGradient) {
  for (int sector = 0; sector < 8; ++sector) {
    const double direction_deg = 45.0 * sector;
    const double through =
        160.0 * std::cos(radians(direction_deg)) + 120.0 * std::sin(radians(direction_deg));
    const auto edges = extract(halfPlane(direction_deg, through)).edges;
    int seen = 0;
    for (int v = 5; v < edges.rows - 5; ++v) {
      for (int u = 5; u < edges.cols - 5; ++u) {
        const int code = edges.at<unsigned char>(v, u);
        if (code == 0) continue;
        EXPECT_EQ(code, 1 + sector) << "at " << u << ", " << v;
        ++seen;
      }
    }
    EXPECT_GT(seen, 100) << sector;
  }
}

TEST(OpencvBackend, KeepsTheBestLinesOfEachClassInOrder) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(40));
  for (int i = 0; i < 8; ++i) {
    cv::line(image, {20 + 36 * i, 10}, {20 + 36 * i, 100 + 15 * i}, cv::Scalar(220), 5);
  }
  EdgeOptions options;
  options.max_lines = 5;
  const auto lines = extract(image, options).lines;
  int of_class[2] = {0, 0};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ++of_class[static_cast<int>(lines[i].line_class)];
    if (i == 0 || lines[i].line_class != lines[i - 1].line_class) continue;
    EXPECT_LE(lines[i].votes, lines[i - 1].votes);
  }
  EXPECT_EQ(of_class[0], 5);
  EXPECT_LE(of_class[1], 5);
}

TEST(OpencvBackend, SurvivesImagesWithoutContent) {
  EXPECT_TRUE(extract(cv::Mat()).lines.empty());
  EXPECT_TRUE(extract(cv::Mat()).edges.empty());
  for (const auto& size : {cv::Size(1, 1), cv::Size(2, 3), cv::Size(1, 200), cv::Size(200, 1)}) {
    const auto result = extract(cv::Mat(size, CV_8UC1, cv::Scalar(128)));
    EXPECT_TRUE(result.lines.empty());
    EXPECT_EQ(cv::countNonZero(result.edges), 0);
  }
}

TEST(OpencvBackend, RefusesAnImageThatIsNotGray) {
  EXPECT_THROW(extract(cv::Mat(20, 20, CV_8UC3)), Error);
}

TEST(OpencvBackend, LeavesTheImageAsItIs) {
  const cv::Mat image = halfPlane(30, 180);
  const cv::Mat before = image.clone();
  extract(image);
  EXPECT_EQ(cv::norm(image, before, cv::NORM_L1), 0.0);
}

TEST(OpencvBackend, IsRepeatable) {
  const cv::Mat image = halfPlane(30, 180);
  const auto first = extract(image);
  const auto second = extract(image);
  EXPECT_EQ(cv::norm(first.edges, second.edges, cv::NORM_L1), 0.0);
  ASSERT_EQ(first.lines.size(), second.lines.size());
  for (std::size_t i = 0; i < first.lines.size(); ++i) {
    EXPECT_EQ(first.lines[i].theta_index, second.lines[i].theta_index);
    EXPECT_EQ(first.lines[i].rho_bin, second.lines[i].rho_bin);
    EXPECT_EQ(first.lines[i].votes, second.lines[i].votes);
  }
}

TEST(EdgeBackends, AnUnknownNameIsAUsageErrorThatNamesTheOthers) {
  try {
    makeEdgeLineBackend("fpga", {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("fpga"));
    EXPECT_THAT(error.what(), HasSubstr("opencv"));
  }
}

TEST(OpencvBackend, SeesTheLinesOfARealCorridor) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  const cv::Mat image =
      cv::imread((folder / "rgb/0000000005.400000.jpg").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(image.empty());
  int of_class[2] = {0, 0};
  for (const auto& line : extract(image).lines) ++of_class[static_cast<int>(line.line_class)];
  EXPECT_GE(of_class[0], 15);
  EXPECT_GE(of_class[1], 15);
}

}  // namespace
}  // namespace colonnade
