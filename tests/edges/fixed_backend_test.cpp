// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/core.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {
namespace {

/// A camera that looks along the robot's x axis, pitched down and rolled.
EdgeView view(double pitch_deg, double roll_deg = 0.0) {
  Eigen::Matrix3d R_level_camera;
  R_level_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(radians(pitch_deg), Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(radians(roll_deg), Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  return {260.0, 260.0, 160.0, 120.0, tilt * R_level_camera};
}

cv::Mat halfPlane(double theta_deg, double rho_px) {
  cv::Mat image(240, 320, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double beyond =
          u * std::cos(radians(theta_deg)) + v * std::sin(radians(theta_deg)) - rho_px;
      image.at<unsigned char>(v, u) =
          static_cast<unsigned char>(60.0 + 120.0 * std::clamp(beyond + 0.5, 0.0, 1.0));
    }
  }
  return image;
}

TEST(FixedBackend, FindsALineWhereItIs) {
  const auto backend = makeEdgeLineBackend("fixed", {});
  const struct {
    double theta_deg, rho_px;
    LineClass line_class;
  } cases[] = {{0, 100, LineClass::kVertical},    {8, 150, LineClass::kVertical},
               {172, -120, LineClass::kVertical}, {46, 200, LineClass::kInclined},
               {90, 120, LineClass::kInclined},   {136, 30, LineClass::kInclined},
               {57, 190, LineClass::kInclined}};
  for (const auto& c : cases) {
    const auto lines = backend->extract(halfPlane(c.theta_deg, c.rho_px)).lines;
    ASSERT_FALSE(lines.empty()) << c.theta_deg;
    EXPECT_NEAR(lines[0].theta_index, c.theta_deg, 1) << c.theta_deg;
    EXPECT_NEAR(lines[0].rho_bin, c.rho_px, 3) << c.theta_deg;
    EXPECT_EQ(lines[0].line_class, c.line_class) << c.theta_deg;
    EXPECT_GE(lines[0].votes, 50) << c.theta_deg;
  }
}

TEST(FixedBackend, EncodesTheDirectionOfTheGradient) {
  const auto backend = makeEdgeLineBackend("fixed", {});
  for (int sector = 0; sector < 8; ++sector) {
    const double through =
        160.0 * std::cos(radians(45.0 * sector)) + 120.0 * std::sin(radians(45.0 * sector));
    const auto edges = backend->extract(halfPlane(45.0 * sector, through)).edges;
    int seen = 0;
    for (int v = 5; v < edges.rows - 5; ++v) {
      for (int u = 5; u < edges.cols - 5; ++u) {
        if (edges.at<unsigned char>(v, u) == 0) continue;
        EXPECT_EQ(edges.at<unsigned char>(v, u), 1 + sector) << "at " << u << ", " << v;
        ++seen;
      }
    }
    EXPECT_GT(seen, 100) << sector;
  }
}

TEST(FixedBackend, SurvivesImagesWithoutContentAndRefusesColour) {
  const auto backend = makeEdgeLineBackend("fixed", {});
  EXPECT_TRUE(backend->extract(cv::Mat()).edges.empty());
  for (const auto& size : {cv::Size(1, 1), cv::Size(2, 3), cv::Size(1, 200), cv::Size(200, 1)}) {
    const auto result = backend->extract(cv::Mat(size, CV_8UC1, cv::Scalar(128)), view(20));
    EXPECT_TRUE(result.lines.empty());
    EXPECT_EQ(cv::countNonZero(result.edges), 0);
  }
  EXPECT_THROW(backend->extract(cv::Mat(20, 20, CV_8UC3)), Error);
}

TEST(FixedBackend, LeavesOutInclinedLinesAboveTheHorizon) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(60));
  image.rowRange(0, 40) = cv::Scalar(180);     // an edge under the ceiling
  image.rowRange(200, 240) = cv::Scalar(180);  // one on the floor
  const auto backend = makeEdgeLineBackend("fixed", {});
  const auto rows = [&](const EdgeView& seen_from) {
    std::vector<int> found;
    for (const auto& line : backend->extract(image, seen_from).lines) {
      if (line.theta_index == 90) found.push_back(line.rho_bin);
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  using ::testing::AllOf;
  using ::testing::ElementsAre;
  using ::testing::Ge;
  using ::testing::Le;
  EXPECT_THAT(rows({}), ElementsAre(AllOf(Ge(38), Le(41)), AllOf(Ge(198), Le(201))));
  EXPECT_THAT(rows(view(5)), ElementsAre(AllOf(Ge(198), Le(201))));
}

TEST(LineRanges, ContainTheProjectedVerticals) {
  const EdgeOptions options;
  const auto level = predictLineRanges(view(0), 320, 240, options);
  EXPECT_EQ(level.vertical_from_deg, -12);
  EXPECT_EQ(level.vertical_to_deg, 12);
  EXPECT_NEAR(level.first_floor_row, 120 - 7, 2);
  // Pitched down, verticals converge downwards: to the right of the centre they lean one way, to
  // the left the other; the horizon is higher up in the image.
  const auto down = predictLineRanges(view(25), 320, 240, options);
  EXPECT_LT(down.vertical_from_deg, -22);
  EXPECT_GT(down.vertical_to_deg, 22);
  EXPECT_EQ(down.first_floor_row, 0);
  const auto rolled = predictLineRanges(view(0, 10), 320, 240, options);
  EXPECT_EQ(std::abs(rolled.vertical_from_deg + rolled.vertical_to_deg), 20);
  // Straight down there is no vertical and no horizon.
  const auto straight = predictLineRanges(view(90), 320, 240, options);
  EXPECT_EQ(straight.vertical_to_deg, 12);
  EXPECT_EQ(straight.first_floor_row, 0);
}

}  // namespace
}  // namespace colonnade
