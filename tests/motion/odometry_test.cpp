// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <memory>

#include "colonnade/base/angle.hpp"
#include "colonnade/motion/motion_estimator.hpp"

namespace colonnade {
namespace {

class WheelOdometry : public ::testing::Test {
 protected:
  MotionEstimator makeEstimator() const {
    return MotionEstimator(options_, std::make_shared<CameraTracker>(options_));
  }
  static Frame at(std::size_t index, const Pose2& T_odom_robot) {
    Frame frame;
    frame.index = index;
    frame.stamp_s = 0.1 * static_cast<double>(index);
    frame.odometry = OdometryReading{T_odom_robot, std::nullopt};
    return frame;
  }
  /// Covariance of a way driven in `steps` equal increments.
  Eigen::Matrix3d covarianceOfWay(const Pose2& step, int steps) const {
    MotionEstimator estimator = makeEstimator();
    Pose2 T_odom;
    Pose2 T_start_robot;
    Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
    estimator.increment(at(0, T_odom));
    for (int i = 1; i <= steps; ++i) {
      T_odom = T_odom * step;
      const auto motion = estimator.increment(at(static_cast<std::size_t>(i), T_odom));
      Eigen::Matrix3d J_start;
      Eigen::Matrix3d J_step;
      T_start_robot = compose(T_start_robot, motion.T_previous_robot, &J_start, &J_step);
      P = J_start * P * J_start.transpose() + J_step * motion.covariance * J_step.transpose();
    }
    return P;
  }
  MotionOptions options_;
};

TEST_F(WheelOdometry, FirstFrameIsNoMotion) {
  auto estimator = makeEstimator();
  const auto motion = estimator.increment(at(0, {3.0, 4.0, 1.0}));
  EXPECT_EQ(motion.source, MotionSource::kNone);
  EXPECT_TRUE(motion.T_previous_robot.vector().isZero());
  EXPECT_TRUE(motion.covariance.isZero());
}

TEST_F(WheelOdometry, IncrementIsInTheFormerRobotsAxes) {
  auto estimator = makeEstimator();
  const Pose2 before{1.0, 2.0, radians(90.0)};
  const Pose2 step{0.3, 0.05, radians(10.0)};
  estimator.increment(at(0, before));
  const auto motion = estimator.increment(at(1, before * step));
  EXPECT_EQ(motion.source, MotionSource::kOdometry);
  EXPECT_LT((motion.T_previous_robot.vector() - step.vector()).norm(), 1e-12);
}

TEST_F(WheelOdometry, UncertaintyOfAWayDoesNotDependOnTheFrameRate) {
  options_.odometry_floor_m = 1e-6;
  options_.odometry_floor_angle = 1e-6;
  const Pose2 short_step{0.05, 0.0, radians(0.4)};
  Pose2 long_step;
  for (int i = 0; i < 10; ++i) long_step = long_step * short_step;
  const Eigen::Matrix3d coarse = covarianceOfWay(long_step, 8);
  const Eigen::Matrix3d fine = covarianceOfWay(short_step, 80);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(fine(i, i) / coarse(i, i), 1.0, 0.05) << i;
  EXPECT_NEAR(std::sqrt(fine(2, 2)),
              std::sqrt(4.0 * options_.odometry_heading * options_.odometry_heading +
                        radians(32.0) * options_.odometry_turn * options_.odometry_turn),
              1e-3);
}

TEST_F(WheelOdometry, RestLeavesLittleButNoZeroUncertainty) {
  auto estimator = makeEstimator();
  estimator.increment(at(0, {1.0, 1.0, 1.0}));
  const auto motion = estimator.increment(at(1, {1.0, 1.0, 1.0}));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(motion.covariance);
  EXPECT_GT(eigen.eigenvalues()(0), 0.0);
  EXPECT_LT(std::sqrt(eigen.eigenvalues()(2)), 1e-3);
}

TEST_F(WheelOdometry, TheLogsCovarianceWinsUnlessItIsNonsense) {
  auto estimator = makeEstimator();
  Eigen::Matrix3d stated = Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal();
  Frame frame = at(1, {0.1, 0.0, 0.0});
  frame.odometry->increment_covariance = stated;
  estimator.increment(at(0, {}));
  EXPECT_LT((estimator.increment(frame).covariance - stated).norm(), 1e-15);

  frame = at(2, {0.2, 0.0, 0.0});
  stated(0, 0) = std::numeric_limits<double>::quiet_NaN();
  frame.odometry->increment_covariance = stated;
  const auto motion = estimator.increment(frame);
  EXPECT_TRUE(motion.covariance.allFinite());
  EXPECT_LT(motion.covariance(1, 1), 0.001);
}

TEST_F(WheelOdometry, AMissingReadingCoastsWithWideNoise) {
  auto estimator = makeEstimator();
  estimator.increment(at(0, {0.0, 0.0, 0.0}));
  const auto measured = estimator.increment(at(1, {0.1, 0.0, 0.0}));
  Frame blind = at(2, {});
  blind.odometry.reset();
  const auto coasted = estimator.increment(blind);
  EXPECT_EQ(coasted.source, MotionSource::kConstantVelocity);
  EXPECT_NEAR(coasted.T_previous_robot.x, 0.1, 1e-9);
  EXPECT_GT(coasted.covariance(0, 0), 10.0 * measured.covariance(0, 0));
  EXPECT_GT(coasted.covariance(2, 2), 10.0 * measured.covariance(2, 2));
  blind.index = 3;
  blind.stamp_s = 0.3;
  EXPECT_GT(estimator.increment(blind).covariance(0, 0), coasted.covariance(0, 0));
  // The reading after a gap has nothing to start from; the one after that has.
  EXPECT_EQ(estimator.increment(at(4, {0.4, 0.0, 0.0})).source, MotionSource::kConstantVelocity);
  EXPECT_EQ(estimator.increment(at(5, {0.5, 0.0, 0.0})).source, MotionSource::kOdometry);
}

TEST(MotionSourceName, IsStable) {
  EXPECT_STREQ(name(MotionSource::kOdometry), "odometry");
  EXPECT_STREQ(name(MotionSource::kConstantVelocity), "constant_velocity");
}

}  // namespace
}  // namespace colonnade
