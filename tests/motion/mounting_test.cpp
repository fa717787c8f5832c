// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>

#include "colonnade/motion/mounting_estimator.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

double tiltBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return std::acos(std::clamp(a.linear().row(2).dot(b.linear().row(2)), -1.0, 1.0));
}

MountingEstimator makeEstimator(const std::string& mode) {
  MotionOptions options;
  options.mounting = mode;
  return MountingEstimator(options, std::make_shared<CameraTracker>(options));
}

TEST(Mounting, FollowsACarriedCamera) {
  Scene scene = Scene::corridor(true, true);
  scene.depth_noise = 0.003;
  auto estimator = makeEstimator("per_frame");
  for (std::size_t i = 0; i < 8; ++i) {
    const double t = static_cast<double>(i);
    const auto T_world_camera =
        cameraInWorld(0.06 * t, 0.0, 1.1 + 0.01 * std::sin(t), 0.0,
                      radians(15.0 + 1.5 * std::sin(0.8 * t)), radians(3.0 * std::cos(0.7 * t)));
    Frame frame = scene.render(i, t / 15.0, T_world_camera);
    // The log's mounting is 6 degrees and 10 cm off.
    frame.T_robot_camera = mountingOf(cameraInWorld(0.0, 0.0, 1.2, 0.0, radians(9.0)));
    estimator.refine(frame);
    const auto truth = mountingOf(T_world_camera);
    EXPECT_LT(tiltBetween(frame.T_robot_camera, truth), radians(0.2)) << i;
    EXPECT_NEAR(frame.T_robot_camera.translation().z(), truth.translation().z(), 0.01) << i;
    EXPECT_TRUE(estimator.uncertainty().floor_seen) << i;
    // x is the projected optical axis, the robot stands under the camera.
    EXPECT_NEAR(frame.T_robot_camera.linear()(1, 2), 0.0, 1e-9);
    EXPECT_TRUE(frame.T_robot_camera.translation().head<2>().isZero(1e-12));
  }
}

TEST(Mounting, CarriesOnWithoutTheFloorAndSaysSo) {
  Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator("per_frame");
  double sigma = 0.0;
  for (std::size_t i = 0; i < 10; ++i) {
    const double t = static_cast<double>(i);
    const auto T_world_camera =
        cameraInWorld(0.05 * t, 0.0, 1.1, 0.0, radians(8.0), radians(0.4 * t));
    Frame frame = scene.render(i, t / 15.0, T_world_camera);
    frame.T_robot_camera = mountingOf(T_world_camera);
    if (i >= 3) {  // somebody stands on it: what lies under the horizon gives no depth
      frame.depth_m.rowRange(100, 240).setTo(0.0f);
    }
    estimator.refine(frame);
    EXPECT_LT(tiltBetween(frame.T_robot_camera, mountingOf(T_world_camera)), radians(0.6)) << i;
    const double now = std::sqrt(estimator.uncertainty().covariance(0, 0));
    if (i >= 4) {
      EXPECT_FALSE(estimator.uncertainty().floor_seen) << i;
      EXPECT_GT(now, sigma) << i;
    }
    sigma = now;
  }
}

TEST(Mounting, IsLeftAloneOnARobot) {
  const Scene scene = Scene::corridor(true, true);
  const auto mounting = mountingOf(cameraInWorld(0.0, 0.0, 1.3, 0.0, radians(3.0)));
  Frame frame = scene.render(0, 0.0, cameraInWorld(0.0, 0.0, 1.1, 0.0, radians(10.0)));
  frame.T_robot_camera = mounting;
  frame.odometry = OdometryReading{};
  auto automatic = makeEstimator("auto");
  automatic.refine(frame);
  EXPECT_FALSE(automatic.isPerFrame());
  EXPECT_TRUE(frame.T_robot_camera.isApprox(mounting));

  frame.odometry.reset();
  auto fixed = makeEstimator("fixed");
  fixed.refine(frame);
  EXPECT_TRUE(frame.T_robot_camera.isApprox(mounting));

  auto carried = makeEstimator("auto");
  carried.refine(frame);
  EXPECT_TRUE(carried.isPerFrame());
  EXPECT_NEAR(frame.T_robot_camera.translation().z(), 1.1, 0.01);
}

TEST(Mounting, AFrameWithoutDepthChangesNothingMuch) {
  auto estimator = makeEstimator("per_frame");
  Frame frame;
  frame.camera = {320, 240, 265.0, 265.0, 159.5, 119.5};
  frame.T_robot_camera = mountingOf(cameraInWorld(0.0, 0.0, 1.2, 0.0, radians(5.0)));
  const auto before = frame.T_robot_camera;
  estimator.refine(frame);
  EXPECT_LT(tiltBetween(frame.T_robot_camera, before), 1e-6);
  EXPECT_FALSE(estimator.uncertainty().floor_seen);
  EXPECT_GT(std::sqrt(estimator.uncertainty().covariance(0, 0)), radians(5.0));
}

}  // namespace
}  // namespace colonnade
