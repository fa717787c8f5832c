// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>

#include "colonnade/motion/motion_estimator.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

constexpr double kPeriod_s = 1.0 / 15.0;

Frame view(const Scene& scene, std::size_t index, const Eigen::Isometry3d& T_world_camera) {
  Frame frame = scene.render(index, kPeriod_s * static_cast<double>(index), T_world_camera);
  frame.T_robot_camera = mountingOf(T_world_camera);
  return frame;
}

MotionEstimator makeEstimator(const MotionOptions& options = {}) {
  return MotionEstimator(options, std::make_shared<CameraTracker>(options));
}

struct Step {
  double x, y, heading;
};

class KnownMotion : public ::testing::TestWithParam<Step> {};

TEST_P(KnownMotion, IsRecoveredWithinMillimetres) {
  const Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator();
  const double pitch = radians(12.0);
  estimator.increment(view(scene, 0, cameraInWorld(0.0, 0.0, 1.1, 0.2, pitch)));
  const Step step = GetParam();
  const Pose2 T_world_before{0.0, 0.0, 0.2};
  const Pose2 T_world_now = T_world_before * Pose2{step.x, step.y, step.heading};
  // The camera also nods and rises, as a carried one does.
  const auto motion =
      estimator.increment(view(scene, 1,
                               cameraInWorld(T_world_now.x, T_world_now.y, 1.12, T_world_now.phi,
                                             pitch + radians(1.0), radians(0.8))));
  EXPECT_EQ(motion.source, MotionSource::kPhotometricIcp);
  EXPECT_NEAR(motion.T_previous_robot.x, step.x, 0.003);
  EXPECT_NEAR(motion.T_previous_robot.y, step.y, 0.003);
  EXPECT_NEAR(motion.T_previous_robot.phi, step.heading, radians(0.1));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(motion.covariance);
  EXPECT_GT(eigen.eigenvalues()(0), 0.0);
  EXPECT_LT(std::sqrt(eigen.eigenvalues()(2)), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Steps, KnownMotion,
                         ::testing::Values(Step{0.0, 0.0, 0.0}, Step{0.08, 0.0, 0.0},
                                           Step{-0.05, 0.03, radians(2.0)},
                                           Step{0.02, 0.0, radians(-6.0)}));

class SharpTurn : public ::testing::TestWithParam<double> {};

TEST_P(SharpTurn, BetweenFramesFarApartInTimeIsFound) {
  const Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator();
  const double pitch = radians(12.0), turn = radians(GetParam());
  const auto at = [&](std::size_t index, double x, double heading) {
    Frame frame = view(scene, index, cameraInWorld(x, 0.0, 1.1, heading, pitch));
    frame.stamp_s = 0.5 * static_cast<double>(index);
    return frame;
  };
  estimator.increment(at(0, 0.0, 0.0));
  estimator.increment(at(1, 0.1, 0.0));  // it has not begun to turn
  const auto motion = estimator.increment(at(2, 0.2, turn));
  EXPECT_EQ(motion.source, MotionSource::kPhotometricIcp);
  EXPECT_NEAR(motion.T_previous_robot.x, 0.1, 0.01);
  EXPECT_NEAR(motion.T_previous_robot.y, 0.0, 0.01);
  EXPECT_NEAR(motion.T_previous_robot.phi, turn, radians(0.2));
}

INSTANTIATE_TEST_SUITE_P(Degrees, SharpTurn, ::testing::Values(-30.0, -22.0, 25.0));

TEST(VisualOdometry, ChangedExposureDoesNotMoveTheCamera) {
  const Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator();
  const auto pose = cameraInWorld(0.0, 0.0, 1.1, 0.0, radians(10.0));
  estimator.increment(view(scene, 0, pose));
  Frame darker = view(scene, 1, pose);
  darker.gray.convertTo(darker.gray, CV_8U, 0.85, -6.0);
  const auto motion = estimator.increment(darker);
  EXPECT_EQ(motion.source, MotionSource::kPhotometricIcp);
  EXPECT_LT(motion.T_previous_robot.translation().norm(), 0.002);
  EXPECT_LT(std::abs(motion.T_previous_robot.phi), radians(0.05));
}

TEST(VisualOdometry, DoesNotClaimTheWayAlongABareCorridor) {
  // Walls and floor without a mark: depth fixes heading and the place across, nothing the way.
  Scene scene = Scene::corridor(false, false);
  scene.depth_noise = 0.002;
  auto estimator = makeEstimator();
  estimator.increment(view(scene, 0, cameraInWorld(0.0, 0.0, 1.1, 0.0, radians(15.0))));
  const auto motion =
      estimator.increment(view(scene, 1, cameraInWorld(0.08, 0.02, 1.1, 0.0, radians(15.0))));
  EXPECT_EQ(motion.source, MotionSource::kIcp);
  EXPECT_GT(std::sqrt(motion.covariance(0, 0)), 0.05);
  EXPECT_LT(std::sqrt(motion.covariance(1, 1)), 0.02);
  EXPECT_LT(std::sqrt(motion.covariance(2, 2)), radians(1.0));
  EXPECT_NEAR(motion.T_previous_robot.y, 0.02, 0.006);
  EXPECT_LT(std::abs(motion.T_previous_robot.x - 0.08), 3.0 * std::sqrt(motion.covariance(0, 0)));
}

/// A plain wall tells a camera that turns before it nothing of the place along it. Shade that goes
/// with the lens must not tell it either.
TEST(VisualOdometry, ATurnBeforeAPlainWallWithASkirtingStaysInItsPlace) {
  Scene scene;
  scene.walls = {{Eigen::Vector3d::UnitZ(), 0.0},
                 {Eigen::Vector3d::UnitX(), 1.6},
                 {Eigen::Vector3d::UnitY(), 1.6},
                 {-Eigen::Vector3d::UnitX(), 1.6},
                 {-Eigen::Vector3d::UnitY(), 1.6}};
  scene.paint = [](const Eigen::Vector3d& p) {
    return p.z() < 1e-6 ? 110.0 : p.z() < 0.11 ? 55.0 : 170.0;
  };
  scene.depth_noise = 0.002;
  scene.brightness_noise = 2.0;
  scene.lens_falloff = 0.45;
  auto estimator = makeEstimator();
  constexpr double kPitch = radians(12.0);
  constexpr double kTurn = radians(4.0);
  // From a corner, where two walls tell the place, past the middle of the next one.
  for (std::size_t i = 0; i < 2; ++i)
    estimator.increment(view(scene, i, cameraInWorld(0.0, 0.0, 1.1, radians(45.0), kPitch)));
  Pose2 T_start_now;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 1; i <= 12; ++i) {
    const double heading = radians(45.0) + kTurn * static_cast<double>(i);
    const auto motion =
        estimator.increment(view(scene, i + 1, cameraInWorld(0.0, 0.0, 1.1, heading, kPitch)));
    Eigen::Matrix3d J_start, J_motion;
    T_start_now = compose(T_start_now, motion.T_previous_robot, &J_start, &J_motion);
    covariance = J_start * covariance * J_start.transpose() +
                 J_motion * motion.covariance * J_motion.transpose();
  }
  const Eigen::Vector2d place = T_start_now.translation();
  EXPECT_LT(place.norm(), 0.1);
  // Chi squared, 1 %, would be 9.2; what is left of the pull errs alike from step to step.
  EXPECT_LT(place.dot(covariance.topLeftCorner<2, 2>().inverse() * place), 30.0);
}

TEST(VisualOdometry, BlankFramesCoastWithGrowingNoise) {
  const Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator();
  MotionIncrement moving;
  for (std::size_t i = 0; i < 4; ++i) {
    moving = estimator.increment(
        view(scene, i, cameraInWorld(0.05 * static_cast<double>(i), 0.0, 1.1, 0.0, 0.2)));
  }
  double former = moving.covariance(0, 0);
  for (std::size_t i = 4; i < 7; ++i) {
    Frame blank = view(scene, i, cameraInWorld(0.0, 0.0, 1.1, 0.0, 0.2));
    blank.gray.setTo(0);
    blank.depth_m.setTo(0.0f);
    const auto coasted = estimator.increment(blank);
    EXPECT_EQ(coasted.source, MotionSource::kConstantVelocity);
    EXPECT_NEAR(coasted.T_previous_robot.x, 0.05, 0.01);
    EXPECT_GT(coasted.covariance(0, 0), 1.3 * former);
    former = coasted.covariance(0, 0);
  }
  // It finds its feet again.
  estimator.increment(view(scene, 7, cameraInWorld(0.4, 0.0, 1.1, 0.0, 0.2)));
  const auto again = estimator.increment(view(scene, 8, cameraInWorld(0.45, 0.0, 1.1, 0.0, 0.2)));
  EXPECT_EQ(again.source, MotionSource::kPhotometricIcp);
  EXPECT_NEAR(again.T_previous_robot.x, 0.05, 0.004);
}

TEST(VisualOdometry, SurfacesCarryOnInTheDark) {
  Scene scene = Scene::corridor(true, true);
  scene.depth_noise = 0.002;
  auto estimator = makeEstimator();
  for (std::size_t i = 0; i < 5; ++i) {
    const double way = 0.05 * static_cast<double>(i);
    Frame frame = view(scene, i, cameraInWorld(way, 0.0, 1.1, 0.0, radians(15.0)));
    if (i == 3) frame.gray.setTo(0);
    if (i == 4) frame.gray.release();
    const auto motion = estimator.increment(frame);
    if (i == 0) continue;
    EXPECT_EQ(motion.source, i < 3 ? MotionSource::kPhotometricIcp : MotionSource::kIcp) << i;
    EXPECT_NEAR(motion.T_previous_robot.x, 0.05, 0.01) << i;
    EXPECT_NEAR(motion.T_previous_robot.y, 0.0, 0.005) << i;
  }
}

TEST(VisualOdometry, AJumpNoRobotCanMakeIsRefused) {
  const Scene scene = Scene::corridor(true, true);
  auto estimator = makeEstimator();
  estimator.increment(view(scene, 0, cameraInWorld(0.0, 0.0, 1.1, 0.0, 0.2)));
  const auto motion =
      estimator.increment(view(scene, 1, cameraInWorld(1.5, 0.0, 1.1, radians(60.0), 0.2)));
  // Either it says that it does not know, or its covariance covers the jump.
  if (motion.source != MotionSource::kConstantVelocity) {
    EXPECT_GT(3.0 * std::sqrt(motion.covariance(0, 0)), std::abs(1.5 - motion.T_previous_robot.x));
  }
}

TEST(VisualOdometry, SameInputSameBytes) {
  const Scene scene = Scene::corridor(true, true);
  std::vector<Eigen::Matrix<double, 3, 4>> runs;
  for (int threads : {1, 4}) {
    cv::setNumThreads(threads);
    auto estimator = makeEstimator();
    MotionIncrement motion;
    for (std::size_t i = 0; i < 3; ++i) {
      motion = estimator.increment(
          view(scene, i, cameraInWorld(0.07 * static_cast<double>(i), 0.0, 1.1, 0.02, 0.2)));
    }
    Eigen::Matrix<double, 3, 4> all;
    all << motion.T_previous_robot.vector(), motion.covariance;
    runs.push_back(all);
  }
  cv::setNumThreads(-1);
  EXPECT_TRUE(runs[0] == runs[1]);
}

TEST(VisualOdometry, OpenCvEnginesAreThereForComparison) {
  const Scene scene = Scene::corridor(true, true);
  for (const char* engine : {"opencv", "opencv_icp", "opencv_rgbd_icp"}) {
    MotionOptions options;
    options.engine = engine;
    auto estimator = makeEstimator(options);
    estimator.increment(view(scene, 0, cameraInWorld(0.0, 0.0, 1.1, 0.0, 0.2)));
    const auto motion =
        estimator.increment(view(scene, 1, cameraInWorld(0.04, 0.0, 1.1, 0.0, 0.2)));
    EXPECT_NE(motion.source, MotionSource::kConstantVelocity) << engine;
    EXPECT_NEAR(motion.T_previous_robot.x, 0.04, 0.01) << engine;
  }
}

}  // namespace
}  // namespace colonnade
