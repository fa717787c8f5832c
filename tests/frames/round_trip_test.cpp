// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "log_helpers.hpp"

namespace colonnade {
namespace {

using testing::readFile;
using testing::readLog;
using testing::record;
using testing::TemporaryFolder;
using testing::writeLog;
using Format = RawlogWriterOptions::Format;

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

struct Storage {
  Format format;
  int gz_level;
};

class RoundTrip : public ::testing::TestWithParam<Storage> {};

TEST_P(RoundTrip, KeepsEveryPixelStampAndPose) {
  const TemporaryFolder folder;
  const auto path = folder / "a.rawlog";
  writeLog(path, 5, {.format = GetParam().format, .gz_level = GetParam().gz_level});
  const auto log = readLog(path);
  ASSERT_EQ(log.frames.size(), 5U);
  EXPECT_EQ(log.damage.ending, LogEnding::kEnd);
  EXPECT_FALSE(log.damage.any());
  for (int i = 0; i < 5; ++i) {
    const auto& frame = log.frames[static_cast<std::size_t>(i)];
    const auto expected = record(i);
    EXPECT_EQ(frame.index, static_cast<std::size_t>(i));
    EXPECT_EQ(frame.stamp_s, expected.stamp_s);
    EXPECT_TRUE(equal(frame.colour, expected.image));
    cv::Mat units;  // back to what was written: must hit every value
    frame.depth_m.convertTo(units, CV_16U, 1.0 / expected.metres_per_unit);
    EXPECT_TRUE(equal(units, expected.depth_units));
    EXPECT_EQ(frame.gray.type(), CV_8UC1);
    EXPECT_EQ(frame.camera.fx_px, expected.camera.fx_px);
    EXPECT_EQ(frame.camera.cy_px, expected.camera.cy_px);
    EXPECT_EQ(frame.camera.width_px, 64);
    EXPECT_TRUE(frame.T_robot_camera.isApprox(expected.T_robot_camera, 1e-9));
    ASSERT_TRUE(frame.odometry);
    EXPECT_LT((frame.odometry->T_odom_robot.vector() - expected.T_odom_robot->vector()).norm(),
              1e-6);
    if (GetParam().format == Format::kActionSensoryFramePairs && i > 0) {
      ASSERT_TRUE(frame.odometry->increment_covariance);
      EXPECT_GT(frame.odometry->increment_covariance->trace(), 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothFormatsPlainAndGz, RoundTrip,
                         ::testing::Values(Storage{Format::kObservationList, 0},
                                           Storage{Format::kObservationList, 1},
                                           Storage{Format::kActionSensoryFramePairs, 0},
                                           Storage{Format::kActionSensoryFramePairs, 6}));

TEST(RawlogWriter, GivesTheSameBytesForTheSameRecords) {
  const TemporaryFolder folder;
  writeLog(folder / "a.rawlog", 3, {.format = Format::kActionSensoryFramePairs});
  writeLog(folder / "b.rawlog", 3, {.format = Format::kActionSensoryFramePairs});
  const auto bytes = readFile(folder / "a.rawlog");
  EXPECT_EQ(bytes, readFile(folder / "b.rawlog"));
  ASSERT_GT(bytes.size(), 8U);
  EXPECT_EQ(bytes[4] | bytes[5] | bytes[6] | bytes[7], 0) << "the gz header bears a time";
}

TEST(RawlogWriter, LeavesNothingBehindUnlessFinished) {
  const TemporaryFolder folder;
  testing::writeFile(folder / "a.rawlog", {1, 2, 3});
  {
    RawlogWriter writer(folder / "a.rawlog");
    writer.add(record(0));
  }
  EXPECT_EQ(readFile(folder / "a.rawlog"), (testing::Bytes{1, 2, 3}));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(RawlogWriter, NamesAFolderThatDoesNotExist) {
  const TemporaryFolder folder;
  try {
    RawlogWriter writer(folder / "none/a.rawlog");
    FAIL() << "an error was expected";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none/a.rawlog"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
  }
}

TEST(RawlogWriter, KeepsAJpegByteByByte) {
  const TemporaryFolder folder;
  auto r = record(0);
  cv::Mat smooth;
  cv::resize(cv::Mat(6, 8, CV_8UC3, cv::Scalar(10, 120, 200)), smooth, {64, 48});
  smooth.rowRange(10, 20).setTo(cv::Scalar(200, 20, 5));
  cv::imencode(".jpg", smooth, r.encoded_image, {cv::IMWRITE_JPEG_QUALITY, 90});
  r.image.release();
  RawlogWriter writer(folder / "a.rawlog", {.gz_level = 0});
  writer.add(r);
  writer.finish();
  const auto bytes = readFile(folder / "a.rawlog");
  EXPECT_NE(std::search(bytes.begin(), bytes.end(), r.encoded_image.begin(), r.encoded_image.end()),
            bytes.end());
  const auto log = readLog(folder / "a.rawlog");
  ASSERT_EQ(log.frames.size(), 1U);
  EXPECT_TRUE(equal(log.frames[0].colour, cv::imdecode(r.encoded_image, cv::IMREAD_COLOR)));
}

TEST(RawlogWriter, StoresGrayImagesAndCompressesColourOnRequest) {
  const TemporaryFolder folder;
  auto r = record(0);
  r.image = testing::texture(3, CV_8UC1);
  RawlogWriter gray(folder / "gray.rawlog");
  gray.add(r);
  gray.finish();
  const auto log = readLog(folder / "gray.rawlog");
  ASSERT_EQ(log.frames.size(), 1U);
  EXPECT_TRUE(log.frames[0].colour.empty());
  EXPECT_TRUE(equal(log.frames[0].gray, r.image));

  r.image = cv::Mat(48, 64, CV_8UC3, cv::Scalar(90, 100, 110));
  RawlogWriter jpeg(folder / "jpeg.rawlog", {.jpeg_quality = 95});
  jpeg.add(r);
  jpeg.finish();
  const auto compressed = readLog(folder / "jpeg.rawlog");
  ASSERT_EQ(compressed.frames.size(), 1U);
  EXPECT_LE(cv::norm(compressed.frames[0].colour, r.image, cv::NORM_INF), 3.0);
}

TEST(RawlogWriter, WritesImagesWithoutDepthAndLandmarksOfOtherPrograms) {
  const TemporaryFolder folder;
  auto r = record(0);
  r.depth_units.release();
  r.range_bearing =
      RangeBearingScan{Eigen::Isometry3d::Identity(), 0.1, 0.02, {{7, 2.5, -0.5, 0.0}}};
  RawlogWriter writer(folder / "a.rawlog", {.format = Format::kActionSensoryFramePairs});
  writer.add(r);
  writer.finish();
  const auto log = readLog(folder / "a.rawlog");
  ASSERT_EQ(log.frames.size(), 1U);
  const auto& frame = log.frames[0];
  EXPECT_TRUE(frame.depth_m.empty());
  EXPECT_TRUE(equal(frame.colour, r.image));
  EXPECT_TRUE(frame.T_robot_camera.isApprox(r.T_robot_camera, 1e-9));
  ASSERT_TRUE(frame.range_bearing);
  ASSERT_EQ(frame.range_bearing->readings.size(), 1U);
  EXPECT_EQ(frame.range_bearing->readings[0].id, 7);
  EXPECT_FLOAT_EQ(static_cast<float>(frame.range_bearing->readings[0].yaw), -0.5F);
  EXPECT_NEAR(frame.range_bearing->yaw_sigma, 0.02, 1e-7);
}

}  // namespace
}  // namespace colonnade
