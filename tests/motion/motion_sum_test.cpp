// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion_sum.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

std::vector<MotionIncrement> curve() {
  std::vector<MotionIncrement> increments(3);
  increments[0].T_previous_robot = {0.3, 0.02, 0.4};
  increments[1].T_previous_robot = {0.2, -0.05, -0.7};
  increments[2].T_previous_robot = {0.4, 0.01, 1.1};
  for (std::size_t i = 0; i < increments.size(); ++i) {
    Eigen::Matrix3d A;
    A << 0.02, 0.004, 0.001, 0.003, 0.01, -0.002, 0.002, 0.001, 0.03;
    A *= 1.0 + 0.5 * static_cast<double>(i);
    increments[i].covariance = A * A.transpose();
  }
  return increments;
}

Pose2 endOf(const std::vector<MotionIncrement>& increments) {
  Pose2 T;
  for (const MotionIncrement& increment : increments) T = T * increment.T_previous_robot;
  return T;
}

TEST(MotionSum, LeadsWhereTheMotionsLead) {
  MotionSum sum;
  for (const MotionIncrement& increment : curve()) sum.add(increment);
  EXPECT_LT((sum.T_start_now().vector() - endOf(curve()).vector()).norm(), 1e-12);
}

TEST(MotionSum, CovarianceIsTheNumericOne) {
  MotionSum sum;
  for (const MotionIncrement& increment : curve()) sum.add(increment);
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < curve().size(); ++i) {
    Eigen::Matrix3d J;
    for (Eigen::Index k = 0; k < 3; ++k) {
      auto plus = curve(), minus = curve();
      const Eigen::Vector3d u = curve()[i].T_previous_robot.vector();
      const auto moved = [&](double by) {
        const Eigen::Vector3d v = u + by * Eigen::Vector3d::Unit(k);
        return Pose2{v.x(), v.y(), v.z()};
      };
      plus[i].T_previous_robot = moved(kStep);
      minus[i].T_previous_robot = moved(-kStep);
      J.col(k) = (endOf(plus).vector() - endOf(minus).vector()) / (2.0 * kStep);
    }
    covariance += J * curve()[i].covariance * J.transpose();
  }
  EXPECT_LT((sum.covariance() - covariance).norm(), 1e-8);
}

}  // namespace
}  // namespace colonnade
