// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/map_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "hall_drive.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;

/// How many pixels are redder than anything but the path is.
int redPixels(const cv::Mat& bgr) {
  int count = 0;
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u) {
      const auto& pixel = bgr.at<cv::Vec3b>(v, u);
      count += pixel[2] > 180 && pixel[0] < 80 && pixel[1] < 80 ? 1 : 0;
    }
  return count;
}

MapPicture hall() {
  MapPicture picture;
  picture.title = "Corridor";
  picture.landmarks = someLandmarks();
  for (const auto& pose : drivePoses()) picture.trajectory.push_back({pose.x, pose.toIsometry3()});
  picture.ground_truth = picture.trajectory;
  return picture;
}

TEST(MapPicture, ShowsTheWholePath) {
  auto picture = hall();
  picture.landmarks.clear();
  picture.ground_truth.clear();
  const auto image = drawMap(picture);
  EXPECT_EQ(image.cols, 1200);
  // 8 m of a 2 px line over 1200 px: at least one red pixel for each column it crosses.
  EXPECT_GT(redPixels(image), 1200);
  picture.trajectory.clear();
  EXPECT_EQ(redPixels(drawMap(picture)), 0);
}

TEST(MapPicture, DrawsMapsOfAnyShape) {
  auto picture = hall();
  for (auto& pose : picture.trajectory)
    pose.T_world_body.translation() = pose.T_world_body.translation().reverse().eval() * 40.0;
  const auto tall = drawMap(picture);
  EXPECT_LE(tall.rows, 1400);
  EXPECT_FALSE(drawMap({}).empty());
  MapPicture point;
  point.trajectory.push_back({});
  EXPECT_FALSE(drawMap(point).empty());
  picture.landmarks[0].p_world.setConstant(std::numeric_limits<double>::quiet_NaN());
  picture.landmarks[1].covariance.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(drawMap(picture).empty());
}

TEST(MapPicture, WritesAPngThatReadsBackAsDrawn) {
  const TemporaryFolder folder;
  writeMapPicture(folder / "map.png", hall());
  const auto image = cv::imread((folder / "map.png").string());
  const auto drawn = drawMap(hall());
  ASSERT_EQ(image.size(), drawn.size());
  EXPECT_EQ(cv::norm(image, drawn, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace colonnade
