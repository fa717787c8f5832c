// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/pose2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/rigid_fit.hpp"
#include "numeric_jacobian.hpp"

namespace colonnade {
namespace {

Pose2 poseOf(const Eigen::VectorXd& v) { return {v(0), v(1), v(2)}; }

TEST(Pose2, InverseUndoes) {
  const Pose2 T{1.2, -0.7, 2.9};
  const Pose2 identity = T * T.inverse();
  EXPECT_LT(identity.vector().norm(), 1e-12);
}

TEST(Pose2, ComposesLikeMatrices) {
  const Pose2 a{1.2, -0.7, 2.9};
  const Pose2 b{-0.3, 2.0, 1.1};
  const Eigen::Isometry3d T = a.toIsometry3() * b.toIsometry3();
  EXPECT_LT(((a * b).toIsometry3().matrix() - T.matrix()).norm(), 1e-12);
  EXPECT_LT((planarPart(T).vector() - (a * b).vector()).norm(), 1e-12);
}

TEST(Pose2, JacobiansAgreeWithNumericOnes) {
  const Eigen::Vector3d a(1.2, -0.7, 0.9);
  const Eigen::Vector3d b(-0.3, 2.0, 1.1);
  Eigen::Matrix3d J_a;
  Eigen::Matrix3d J_b;
  compose(poseOf(a), poseOf(b), &J_a, &J_b);
  const auto by_a = testing::numericJacobian(
      [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return (poseOf(v) * poseOf(b)).vector(); },
      a);
  const auto by_b = testing::numericJacobian(
      [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return (poseOf(a) * poseOf(v)).vector(); },
      b);
  EXPECT_LT((J_a - by_a).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((J_b - by_b).cwiseAbs().maxCoeff(), 1e-8);

  const Eigen::Vector2d p(0.4, -1.5);
  Eigen::Matrix<double, 2, 3> J_pose;
  Eigen::Matrix2d J_point;
  transform(poseOf(a), p, &J_pose, &J_point);
  const auto by_pose = testing::numericJacobian(
      [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return transform(poseOf(v), p); }, a);
  EXPECT_LT((J_pose - by_pose).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Pose2, ExponentialIsManySmallSteps) {
  for (const Eigen::Vector3d& xi :
       {Eigen::Vector3d(0.7, -2.0, 1.1), Eigen::Vector3d(3.0, 1.0, -2.9),
        Eigen::Vector3d(0.4, 0.2, 1e-6), Eigen::Vector3d(1.0, 0.0, 0.0)}) {
    constexpr int kSteps = 100'000;
    Pose2 small{xi(0) / kSteps, xi(1) / kSteps, xi(2) / kSteps}, all;
    for (int i = 0; i < kSteps; ++i) all = all * small;
    const Pose2 T = exponential(xi);
    EXPECT_LT((T.translation() - all.translation()).norm(), 1e-4);
    EXPECT_NEAR(T.phi, all.phi, 1e-9);
  }
  // The two ways to the spread meet.
  EXPECT_LT((spreadOverTurn(0.99e-4) - spreadOverTurn(1.01e-4)).norm(), 2e-6);
}

TEST(Angle, WrapsIntoItsInterval) {
  EXPECT_NEAR(wrapAngle(3.5 * kPi), -0.5 * kPi, 1e-12);
  EXPECT_NEAR(wrapQuarterTurn(radians(89.0)), radians(-1.0), 1e-12);
}

TEST(RigidFit, LaysPointsOntoTheirLikes) {
  const Pose2 T_a_b{3.0, -2.0, 2.5};
  std::vector<PointPair> pairs;
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(100.0, 40.0), Eigen::Vector2d(101.0, 43.0), Eigen::Vector2d(97.0, 41.5)})
    pairs.push_back({transform(T_a_b, p), p});
  EXPECT_LT((rigidFit(pairs).vector() - T_a_b.vector()).norm(), 1e-9);
  pairs.push_back({{0.0, 0.0}, {500.0, 0.0}, 0.0});  // of no weight
  EXPECT_LT((rigidFit(pairs).vector() - T_a_b.vector()).norm(), 1e-9);
}

TEST(RigidFit, LeavesTheLeastSquares) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  std::vector<PointPair> pairs;
  for (int i = 0; i < 20; ++i)
    pairs.push_back(
        {{gauss(random), gauss(random)}, {gauss(random), gauss(random)}, std::abs(gauss(random))});
  const auto cost = [&](const Pose2& T) {
    double sum = 0.0;
    for (const auto& [p_a, p_b, weight] : pairs)
      sum += weight * (transform(T, p_b) - p_a).squaredNorm();
    return sum;
  };
  const Pose2 best = rigidFit(pairs);
  for (int i = 0; i < 100; ++i)
    EXPECT_GE(
        cost(exponential({0.1 * gauss(random), 0.1 * gauss(random), 0.1 * gauss(random)}) * best),
        cost(best));
}

}  // namespace
}  // namespace colonnade
