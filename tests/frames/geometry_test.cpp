// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>

#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "log_helpers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using testing::readLog;
using testing::TemporaryFolder;

constexpr int kWidth = 320, kHeight = 240;

/// A wall 3 m ahead and, before its right half, a board at 1.5 m: what a depth camera at p sees.
/// Points are in a frame with the axes of the cameras.
double trueDepth(const Eigen::Vector3d& p_camera, const Eigen::Vector3d& ray) {
  const double wall = 3.0 - p_camera.z(), board = 1.5 - p_camera.z();
  return p_camera.x() + board * ray.x() > 0.1 ? board : wall;
}

mrpt::img::TCamera camera(double fx, double fy, double cx, double cy) {
  mrpt::img::TCamera result;
  result.ncols = kWidth;
  result.nrows = kHeight;
  result.setIntrinsicParamsFromValues(fx, fy, cx, cy);
  return result;
}

CObservation3DRangeScan scene(const mrpt::img::TCamera& depth_camera,
                              const Eigen::Vector3d& p_depth_camera) {
  CObservation3DRangeScan scan;
  scan.timestamp = testing::stamp(10.0);
  scan.sensorLabel = "KINECT";
  scan.cameraParams = depth_camera;
  scan.cameraParamsIntensity = depth_camera;
  scan.hasRangeImage = true;
  scan.range_is_depth = true;
  scan.rangeUnits = 0.001F;
  scan.rangeImage_setSize(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray((u - depth_camera.cx()) / depth_camera.fx(),
                                (v - depth_camera.cy()) / depth_camera.fy(), 1.0);
      scan.rangeImage(v, u) =
          static_cast<std::uint16_t>(std::lround(1000.0 * trueDepth(p_depth_camera, ray)));
    }
  return scan;
}

void addImage(CObservation3DRangeScan& scan) {
  scan.hasIntensityImage = true;
  scan.intensityImage.resize(kWidth, kHeight, mrpt::img::CH_RGB);
  scan.intensityImage.filledRectangle(0, 0, kWidth - 1, kHeight - 1, mrpt::img::TColor(10, 20, 30));
}

template <class... Observations>
Frame only(const TemporaryFolder& folder, const SourceOptions& options,
           const Observations&... all) {
  {
    testing::MrptLog log(folder / "a.rawlog");
    (log.add(all), ...);
  }
  auto read = readLog(folder / "a.rawlog", options);
  EXPECT_EQ(read.frames.size(), 1U);
  EXPECT_FALSE(read.damage.any());
  return read.frames.empty() ? Frame{} : read.frames.front();
}

TEST(Registration, DepthIsSeenFromAColourCameraBesideIt) {
  const TemporaryFolder folder;
  const Eigen::Vector3d p_depth(0.0, 0.0, 0.0), p_colour(-0.025, 0.0, 0.01);
  auto scan = scene(camera(290, 290, 158.0, 121.0), p_depth);
  addImage(scan);
  scan.cameraParamsIntensity = camera(262, 263, 161.0, 118.5);
  // The colour camera 2.5 cm to the left of the depth camera and 1 cm ahead (x forward, y left).
  scan.relativePoseIntensityWRTDepth =
      mrpt::poses::CPose3D(0.01, 0.025, 0.0, -M_PI / 2, 0.0, -M_PI / 2);
  const auto frame = only(folder, {}, scan);
  ASSERT_EQ(frame.depth_m.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(frame.camera.fx_px, 262);
  int wrong = 0, holes = 0, all = 0;
  for (int v = 20; v < kHeight - 20; ++v)
    for (int u = 25; u < kWidth - 25; ++u) {
      const double expected = trueDepth(p_colour, frame.camera.ray(u, v));
      const double got = static_cast<double>(frame.depth_m.at<float>(v, u));
      ++all;
      if (got == 0.0)
        ++holes;
      else if (std::abs(got - expected) > 0.003)
        ++wrong;
    }
  // Holes: the wall the board hides from the depth camera only; wrong: the board's edge by a pixel.
  EXPECT_LT(holes, all / 50);
  EXPECT_LT(wrong, all / 100);
  EXPECT_GT(holes, 0) << "occlusion must not be filled";
}

TEST(Registration, CoincidingCamerasKeepEveryPixel) {
  const TemporaryFolder folder;
  auto scan = scene(camera(290, 290, 158.0, 121.0), Eigen::Vector3d::Zero());
  addImage(scan);
  const auto frame = only(folder, {}, scan);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u)
      ASSERT_EQ(frame.depth_m.at<float>(v, u),
                static_cast<float>(scan.rangeImage(v, u)) * scan.rangeUnits);
}

TEST(Registration, PixelAlignmentCanBeInsistedOn) {
  const TemporaryFolder folder;
  auto scan = scene(camera(290, 290, 158.0, 121.0), Eigen::Vector3d::Zero());
  addImage(scan);
  scan.cameraParamsIntensity = camera(262, 263, 161.0, 118.5);
  SourceOptions options;
  options.depth_alignment = "pixels";
  const auto frame = only(folder, options, scan);
  EXPECT_EQ(frame.depth_m.at<float>(17, 200),
            static_cast<float>(scan.rangeImage(17, 200)) * 0.001F);
}

TEST(Registration, ADriversRegisteredDepthIsRecognisedByItsEdges) {
  COLONNADE_REQUIRE_RECORDING(path, "mrpt/tests_rgbd.rawlog");
  RawlogSource source(path);
  const auto frame = source.next();
  ASSERT_TRUE(frame);
  ASSERT_EQ(source.notes().size(), 1U);
  EXPECT_EQ(frame->depth_m.size(), cv::Size(640, 480));
  // The suitcase on the shelf: its upper edge lies at row 155 in the picture; the wall above is
  // farther away. By the log's calibration the jump would lie 28 rows lower.
  const float suitcase = frame->depth_m.at<float>(170, 200),
              wall = frame->depth_m.at<float>(145, 200);
  EXPECT_GT(wall - suitcase, 0.2F);
  SourceOptions by_log;
  by_log.depth_alignment = "log";
  RawlogSource insisting(path, by_log);
  const auto other = insisting.next();
  ASSERT_TRUE(other);
  EXPECT_LT(std::abs(other->depth_m.at<float>(170, 200) - other->depth_m.at<float>(145, 200)),
            0.1F);
}

TEST(Depth, DistancesAlongTheRayBecomeDepth) {
  const TemporaryFolder folder;
  const auto intrinsics = camera(200, 200, 160, 120);
  auto scan = scene(intrinsics, Eigen::Vector3d::Zero());
  scan.range_is_depth = false;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray((u - 160.0) / 200.0, (v - 120.0) / 200.0, 1.0);
      scan.rangeImage(v, u) = static_cast<std::uint16_t>(std::lround(2000.0 * ray.norm()));
    }
  scan.rangeImage(5, 5) = 0;
  const auto frame = only(folder, {}, scan);
  EXPECT_EQ(frame.depth_m.at<float>(5, 5), 0.0F);
  EXPECT_TRUE(frame.gray.empty());
  for (const auto& [v, u] : {std::pair{0, 0}, {120, 160}, {239, 319}, {0, 319}})
    EXPECT_NEAR(static_cast<double>(frame.depth_m.at<float>(v, u)), 2.0, 0.001);
}

TEST(Poses, EveryClassGivesTheOpticalFrame) {
  const TemporaryFolder folder;
  // Sensor 0.3 m ahead, 0.9 m up, looking 20 degrees down and turned 10 degrees left.
  const mrpt::poses::CPose3D sensor(0.3, 0.1, 0.9, 0.1745329, 0.3490659, 0.0);
  const mrpt::poses::CPose3D optical =
      sensor + mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0.0, -M_PI / 2);
  auto scan = scene(camera(290, 290, 158.0, 121.0), Eigen::Vector3d::Zero());
  scan.sensorPose = sensor;
  const auto depth_only = only(folder, {}, scan);
  CObservationImage image;
  image.timestamp = testing::stamp(10.0);
  image.cameraPose = optical;
  image.cameraParams = camera(290, 290, 158.0, 121.0);
  image.image.resize(kWidth, kHeight, mrpt::img::CH_GRAY);
  const auto picture = only(folder, {}, image);
  EXPECT_TRUE(depth_only.T_robot_camera.isApprox(picture.T_robot_camera, 1e-9));
  // Forward in the camera: ahead, left and down on the robot.
  const Eigen::Vector3d forward = picture.T_robot_camera.linear().col(2);
  EXPECT_NEAR(forward.x(), std::cos(0.3490659) * std::cos(0.1745329), 1e-6);
  EXPECT_NEAR(forward.y(), std::cos(0.3490659) * std::sin(0.1745329), 1e-6);
  EXPECT_NEAR(forward.z(), -std::sin(0.3490659), 1e-6);
  // x of the camera: to the robot's right, level.
  EXPECT_LT(picture.T_robot_camera.linear()(1, 0), -0.9);
  EXPECT_NEAR(picture.T_robot_camera.linear()(2, 0), 0.0, 1e-9);
  EXPECT_NEAR(picture.T_robot_camera.translation().z(), 0.9, 1e-12);
}

TEST(Poses, OptionsReplaceHeightAndTilt) {
  const TemporaryFolder folder;
  auto scan = scene(camera(290, 290, 158.0, 121.0), Eigen::Vector3d::Zero());
  scan.sensorPose = mrpt::poses::CPose3D(0.3, 0.1, 0.9, 0.5, 0.0, 0.0);
  SourceOptions options;
  options.height_m = 1.5;
  options.tilt = "given";
  options.pitch = 0.25;
  options.roll = -0.1;
  const auto frame = only(folder, options, scan);
  const auto& R = frame.T_robot_camera.linear();
  EXPECT_NEAR(frame.T_robot_camera.translation().z(), 1.5, 1e-12);
  EXPECT_NEAR(frame.T_robot_camera.translation().x(), 0.3, 1e-12);
  EXPECT_NEAR(-std::asin(R(2, 2)), 0.25, 1e-9);
  EXPECT_NEAR(std::atan2(-R(2, 0), -R(2, 1)), -0.1, 1e-9);
  EXPECT_NEAR(std::atan2(R(1, 2), R(0, 2)), 0.5, 1e-9) << "the heading of the camera is the log's";
}

TEST(Lens, DistortionIsTakenOutOfImagesAndDepth) {
  const TemporaryFolder folder;
  // Straight vertical lines of the world, drawn where a lens with strong barrel distortion puts
  // them (Brown's model, k1 only).
  const double f = 250, cx = 159.5, cy = 119.5, k1 = -0.25;
  CObservation3DRangeScan scan;
  scan.timestamp = testing::stamp(1.0);
  scan.cameraParams = camera(f, f, cx, cy);
  scan.cameraParams.setDistortionPlumbBob(k1, 0, 0, 0, 0);
  scan.cameraParamsIntensity = scan.cameraParams;
  cv::Mat pixels(kHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  scan.hasRangeImage = true;
  scan.rangeImage_setSize(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      // Undistort this pixel by fixed point iteration.
      const Eigen::Vector2d distorted((u - cx) / f, (v - cy) / f);
      Eigen::Vector2d ideal = distorted;
      for (int i = 0; i < 30; ++i) ideal = distorted / (1.0 + k1 * ideal.squaredNorm());
      const bool dark = ideal.x() * f + cx < 60.0;
      if (dark) pixels.at<cv::Vec3b>(v, u) = {0, 0, 0};
      scan.rangeImage(v, u) = dark ? 1000 : 3000;
    }
  scan.hasIntensityImage = true;
  scan.intensityImage = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
  const auto frame = only(folder, {}, scan);
  EXPECT_EQ(frame.camera.fx_px, f);
  for (int v = 10; v < kHeight - 10; ++v) {
    EXPECT_LT(frame.gray.at<std::uint8_t>(v, 56), 40) << "row " << v;
    EXPECT_GT(frame.gray.at<std::uint8_t>(v, 63), 215) << "row " << v;
    EXPECT_FLOAT_EQ(frame.depth_m.at<float>(v, 56), 1.0F) << "row " << v;
    EXPECT_FLOAT_EQ(frame.depth_m.at<float>(v, 63), 3.0F) << "row " << v;
  }
}

TEST(Calibration, MissingAsksForIt) {
  const TemporaryFolder folder;
  CObservationImage image;
  image.timestamp = testing::stamp(1.0);
  image.image.resize(kWidth, kHeight, mrpt::img::CH_RGB);
  {
    testing::MrptLog log(folder / "a.rawlog");
    log.add(image);
  }
  try {
    readLog(folder / "a.rawlog");
    FAIL() << "an error was expected";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("Camera.fx_px"), std::string::npos);
  }
  SourceOptions options;
  options.fx_px = options.fy_px = 300;
  options.cx_px = 160;
  options.cy_px = 120;
  const auto read = readLog(folder / "a.rawlog", options);
  ASSERT_EQ(read.frames.size(), 1U);
  EXPECT_EQ(read.frames[0].camera.fx_px, 300);
  EXPECT_EQ(read.frames[0].camera.width_px, kWidth);
  options.cy_px = 0;
  EXPECT_THROW(RawlogSource(folder / "a.rawlog", options), Error);
  SourceOptions tilt;
  tilt.pitch = 0.1;
  EXPECT_THROW(RawlogSource(folder / "a.rawlog", tilt), Error);
}

TEST(Calibration, OfAnotherSizeIsScaledAndOfOtherProportionsRefused) {
  const TemporaryFolder folder;
  CObservationImage image;
  image.timestamp = testing::stamp(1.0);
  image.cameraParams = camera(580, 580, 319.5, 239.5);
  image.cameraParams.ncols = 640;
  image.cameraParams.nrows = 480;
  image.image.resize(kWidth, kHeight, mrpt::img::CH_RGB);
  const auto frame = only(folder, {}, image);
  EXPECT_DOUBLE_EQ(frame.camera.fx_px, 290);
  EXPECT_DOUBLE_EQ(frame.camera.cx_px, 159.5);  // the centre stays the centre
  image.cameraParams.nrows = 400;
  {
    testing::MrptLog log(folder / "b.rawlog");
    log.add(image);
  }
  const auto read = readLog(folder / "b.rawlog");
  EXPECT_TRUE(read.frames.empty());
  ASSERT_EQ(read.damage.skipped.size(), 1U);
  EXPECT_NE(read.damage.skipped.begin()->first.find("640x400"), std::string::npos);
}

}  // namespace
}  // namespace colonnade
