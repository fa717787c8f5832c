// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <random>

#include "colonnade/base/angle.hpp"
#include "log_helpers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationOdometry;
using testing::readLog;
using testing::stamp;
using testing::TemporaryFolder;

mrpt::img::TCamera smallCamera() {
  mrpt::img::TCamera camera;
  camera.ncols = 32;
  camera.nrows = 24;
  camera.setIntrinsicParamsFromValues(30, 30, 15.5, 11.5);
  return camera;
}

CObservationImage image(double stamp_s, const std::string& label = "CAM") {
  CObservationImage result;
  result.timestamp = stamp(stamp_s);
  result.sensorLabel = label;
  result.cameraParams = smallCamera();
  result.cameraPose = mrpt::poses::CPose3D(0, 0, 1, -M_PI / 2, 0, -M_PI / 2);
  result.image.resize(32, 24, mrpt::img::CH_RGB);
  return result;
}

CObservation3DRangeScan depth(double stamp_s, std::uint16_t units) {
  CObservation3DRangeScan result;
  result.timestamp = stamp(stamp_s);
  result.sensorLabel = "DEPTH";
  result.cameraParams = smallCamera();
  result.sensorPose = mrpt::poses::CPose3D(0, 0, 1, 0, 0, 0);
  result.hasRangeImage = true;
  result.rangeImage_setSize(24, 32);
  result.rangeImage.fill(units);
  return result;
}

CObservationOdometry odometry(double stamp_s, const Pose2& pose) {
  CObservationOdometry result;
  result.timestamp = stamp(stamp_s);
  result.sensorLabel = "WHEELS";
  result.odometry = mrpt::poses::CPose2D(pose.x, pose.y, pose.phi);
  return result;
}

TEST(Assembly, ImageAndDepthJoinWithinTwoHundredthsOfASecond) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    log.add(image(1.000));
    log.add(depth(1.015, 2000));
    log.add(depth(1.090, 2500));  // before its image, and in another order than their stamps
    log.add(image(1.080));
    log.add(image(1.200));
    log.add(depth(1.235, 3000));  // too late for it
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_NEAR(read.frames[0].stamp_s, 1.000, 1e-6) << "a frame bears the stamp of its image";
  EXPECT_NEAR(read.frames[1].stamp_s, 1.080, 1e-6);
  EXPECT_FLOAT_EQ(read.frames[0].depth_m.at<float>(12, 16), 2.0F);
  EXPECT_FLOAT_EQ(read.frames[1].depth_m.at<float>(12, 16), 2.5F);
  EXPECT_TRUE(read.frames[2].depth_m.empty());
  EXPECT_EQ(read.damage.ignored.at("depth without an image within 0.02 s"), 1U);
  EXPECT_FALSE(read.damage.any());
}

TEST(Assembly, DepthAloneIsAFrameInALogWithoutImages) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    for (int i = 0; i < 3; ++i) log.add(depth(1.0 + 0.1 * i, 1500));
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_TRUE(read.frames[0].gray.empty());
  EXPECT_EQ(read.frames[0].camera.width_px, 32);
  EXPECT_NEAR(read.frames[0].T_robot_camera.translation().z(), 1.0, 1e-12);
}

TEST(Assembly, TheFirstCameraIsUsedUnlessAnotherIsAskedFor) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    for (int i = 0; i < 3; ++i) {
      log.add(image(1.0 + 0.1 * i, "LEFT"));
      log.add(image(1.005 + 0.1 * i, "RIGHT"));
    }
  }
  const auto left = readLog(folder / "a.rawlog");
  ASSERT_EQ(left.frames.size(), 3U);
  EXPECT_NEAR(left.frames[0].stamp_s, 1.0, 1e-6);
  EXPECT_EQ(left.damage.ignored.at("mrpt::obs::CObservationImage"), 3U);
  SourceOptions options;
  options.sensor_label = "RIGHT";
  const auto right = readLog(folder / "a.rawlog", options);
  ASSERT_EQ(right.frames.size(), 3U);
  EXPECT_NEAR(right.frames[0].stamp_s, 1.005, 1e-6);
}

TEST(Assembly, StampsThatRepeatGoBackOrAreNoTimeAreRefused) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    log.add(image(10.0));
    log.add(image(10.0));
    log.add(image(10.1));
    log.add(image(11.0));
    log.add(image(9.5));
    log.add(image(11.1));
    auto never = image(0.0);
    never.timestamp = INVALID_TIMESTAMP;
    log.add(never);
    log.add(image(8e9));
    log.add(image(11.2));
  }
  const auto read = readLog(folder / "a.rawlog");
  std::vector<double> stamps;
  for (const auto& frame : read.frames) stamps.push_back(frame.stamp_s);
  EXPECT_EQ(stamps, (std::vector<double>{10.0, 10.1, 11.0, 11.1, 11.2}));
  EXPECT_EQ(read.damage.skipped.at("frame whose stamp repeats"), 1U);
  EXPECT_EQ(read.damage.skipped.at("frame whose stamp goes back"), 1U);
  EXPECT_EQ(read.damage.skipped.at("frame with an invalid stamp"), 2U);
}

TEST(Assembly, OdometryIsInterpolatedAtTheStampOfTheFrame) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    log.add(odometry(1.00, {0.0, 0.0, radians(170)}));
    log.add(image(1.05));
    log.add(image(1.15));
    log.add(odometry(1.10, {1.0, 2.0, radians(-170)}));  // turned through 180 degrees
    log.add(odometry(1.20, {2.0, 2.0, radians(-170)}));
    log.add(image(1.25));  // a little beyond: the motion goes on
    log.add(image(3.00));  // far beyond: nobody knows
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 4U);
  const auto expectPose = [&](std::size_t i, const Pose2& expected) {
    ASSERT_TRUE(read.frames[i].odometry) << "frame " << i;
    const auto& got = read.frames[i].odometry->T_odom_robot;
    EXPECT_NEAR(got.x, expected.x, 1e-5) << "frame " << i;
    EXPECT_NEAR(got.y, expected.y, 1e-5) << "frame " << i;
    EXPECT_NEAR(wrapAngle(got.phi - expected.phi), 0.0, 1e-5) << "frame " << i;
    EXPECT_FALSE(read.frames[i].odometry->increment_covariance);
  };
  expectPose(0, {0.5, 1.0, radians(180)});
  expectPose(1, {1.5, 2.0, radians(-170)});
  expectPose(2, {2.5, 2.0, radians(-170)});
  EXPECT_FALSE(read.frames[3].odometry);
}

TEST(Assembly, AHoleInTheOdometryIsNotBridged) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    log.add(odometry(1.0, {0, 0, 0}));
    log.add(odometry(1.1, {0.1, 0, 0}));
    log.add(image(3.0));
    log.add(odometry(5.0, {4, 0, 0}));
    log.add(odometry(5.1, {4.1, 0, 0}));
    log.add(image(5.05));
    log.add(odometry(5.1, {9, 9, 9}));  // repeats its stamp
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_FALSE(read.frames[0].odometry);
  ASSERT_TRUE(read.frames[1].odometry);
  EXPECT_NEAR(read.frames[1].odometry->T_odom_robot.x, 4.05, 1e-6);
  EXPECT_EQ(read.damage.skipped.at("odometry whose stamp repeats or goes back"), 1U);
}

mrpt::obs::CActionCollection action(const Pose2& motion, const Eigen::Matrix3d& covariance) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  auto change = std::make_shared<mrpt::poses::CPosePDFGaussian>();
  change->mean = mrpt::poses::CPose2D(motion.x, motion.y, motion.phi);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) change->cov(row, column) = covariance(row, column);
  movement.poseChange = mrpt::poses::CPosePDF::Ptr(change);
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  return actions;
}

TEST(Assembly, ActionsAddUpBetweenFramesWithTheirCovariance) {
  const TemporaryFolder folder;
  const Pose2 motions[] = {{0.5, 0.1, 0.4}, {0.3, -0.1, -0.2}, {0.2, 0.05, 0.1}};
  const Eigen::Matrix3d each = Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal();
  {
    testing::MrptLog log(folder / "a.rawlog");
    mrpt::obs::CSensoryFrame with_image, laser;
    with_image.insert(std::make_shared<CObservationImage>(image(1.0)));
    laser.insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>());
    log.add(with_image);
    log.add(action(motions[0], each));
    log.add(laser);  // no frame; its action counts for the next one
    log.add(action(motions[1], each));
    with_image.clear();
    with_image.insert(std::make_shared<CObservationImage>(image(1.0)));  // repeats: refused
    log.add(with_image);
    log.add(action(motions[2], each));
    with_image.clear();
    with_image.insert(std::make_shared<CObservationImage>(image(2.0)));
    log.add(with_image);
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 2U);
  ASSERT_TRUE(read.frames[0].odometry) << "an action follows, so there is odometry from the start";
  EXPECT_LT(read.frames[0].odometry->T_odom_robot.vector().norm(), 1e-12);
  const Pose2 sum = motions[0] * motions[1] * motions[2];
  ASSERT_TRUE(read.frames[1].odometry);
  EXPECT_LT((read.frames[1].odometry->T_odom_robot.vector() - sum.vector()).norm(), 1e-9);

  // The covariance against samples: independent noise on each increment, added up exactly.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    Pose2 noisy;
    for (const auto& m : motions)
      noisy = noisy * Pose2{m.x + 0.01 * normal(random), m.y + 0.02 * normal(random),
                            m.phi + 0.03 * normal(random)};
    const Eigen::Vector3d error = noisy.vector() - sum.vector();
    sampled += error * error.transpose() / kSamples;
  }
  ASSERT_TRUE(read.frames[1].odometry->increment_covariance);
  const Eigen::Matrix3d got = *read.frames[1].odometry->increment_covariance;
  EXPECT_LT((got - sampled).norm(), 0.05 * sampled.norm()) << got << "\n\n" << sampled;
}

TEST(Assembly, SensoryFramesWithoutActionsHaveNoOdometry) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    for (int i = 0; i < 3; ++i) {
      mrpt::obs::CSensoryFrame frame;
      frame.insert(std::make_shared<CObservationImage>(image(1.0 + i)));
      frame.insert(std::make_shared<CObservation3DRangeScan>(depth(1.05 + i, 1000)));
      log.add(frame);
    }
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_FALSE(read.frames[0].odometry);
  EXPECT_FALSE(read.frames[2].odometry);
  EXPECT_FALSE(read.frames[1].depth_m.empty()) << "a sensory frame is one instant";
}

TEST(Assembly, AMissingImageFileLosesTheImageOnly) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a_Images");
  {
    testing::MrptLog log(folder / "a.rawlog");
    for (int i = 0; i < 2; ++i) {
      auto scan = depth(1.0 + i, 2000);
      scan.sensorLabel = "RGBD";
      scan.cameraParamsIntensity = scan.cameraParams;
      scan.hasIntensityImage = true;
      const std::string file = "img_" + std::to_string(i) + ".png";
      if (i == 0) {
        mrpt::img::CImage picture(32, 24, mrpt::img::CH_RGB);
        picture.filledRectangle(0, 0, 31, 23, mrpt::img::TColor(255, 0, 0));
        ASSERT_TRUE(picture.saveToFile((folder / ("a_Images/" + file)).string()));
      }
      scan.intensityImage.setExternalStorage(file);
      log.add(scan);
    }
  }
  const auto read = readLog(folder / "a.rawlog");
  ASSERT_EQ(read.frames.size(), 2U) << read.damage.detail;
  ASSERT_FALSE(read.frames[0].colour.empty());
  EXPECT_EQ(read.frames[0].colour.at<cv::Vec3b>(5, 5), cv::Vec3b(0, 0, 255)) << "BGR";
  EXPECT_TRUE(read.frames[1].colour.empty());
  EXPECT_FALSE(read.frames[1].depth_m.empty());
  EXPECT_EQ(read.damage.skipped.at("image file missing or unreadable"), 1U);
}

TEST(Recordings, MrptsLandmarkDemoGivesReadingsAndOdometry) {
  COLONNADE_REQUIRE_RECORDING(path, "mrpt/kf-slam_demo.rawlog");
  const auto read = readLog(path);
  ASSERT_EQ(read.frames.size(), 250U);
  EXPECT_EQ(read.damage.ending, LogEnding::kEnd);
  EXPECT_FALSE(read.damage.any());
  for (const auto& frame : read.frames) {
    ASSERT_TRUE(frame.range_bearing);
    ASSERT_TRUE(frame.odometry);
    for (const auto& reading : frame.range_bearing->readings) {
      EXPECT_GE(reading.id, 0);
      EXPECT_GT(reading.range_m, 0.0);
    }
  }
  EXPECT_TRUE(read.frames[1].odometry->increment_covariance);
}

TEST(Recordings, OldLaserLogsOfMrpt1AreWalkedToTheirEnd) {
  COLONNADE_REQUIRE_RECORDING(path, "mrpt/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog");
  const auto read = readLog(path);
  EXPECT_EQ(read.damage.ending, LogEnding::kEnd);
  EXPECT_EQ(read.damage.entries_read, 449U);
  EXPECT_EQ(read.damage.ignored.at("mrpt::obs::CObservation2DRangeScan"), 225U);
}

}  // namespace
}  // namespace colonnade
