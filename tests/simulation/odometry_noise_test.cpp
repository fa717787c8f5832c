// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/odometry_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace colonnade {
namespace {

const Pose2 kStep{0.1, 0.0, radians(2.0)};

OdometryOptions perfect() {
  OdometryOptions o;
  o.scale = o.turn_bias_per_m = o.turn_scale = 0.0;
  o.forward_noise_m = o.sideways_noise_m = o.turn_noise_per_m = o.turn_noise_per_rad = 0.0;
  return o;
}

TEST(Random, isTheSameEverywhere) {
  // The engine is fixed by the C++ standard; these values guard seeding and distributions.
  Random random(7, "test");
  double sum = 0.0, square = 0.0;
  const int count = 200000;
  for (int i = 0; i < count; ++i) {
    const double value = random.normal();
    sum += value;
    square += value * value;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.01);
  EXPECT_NEAR(square / count, 1.0, 0.015);
  Random a(7, "test"), b(7, "test"), other_seed(8, "test"), other_stream(7, "tess");
  const double first = a.uniform();
  EXPECT_EQ(first, b.uniform());
  EXPECT_NE(first, other_seed.uniform());
  EXPECT_NE(first, other_stream.uniform());
}

TEST(OdometryNoise, perfectWheelsReportTheTruth) {
  OdometryNoise noise(perfect(), 1);
  const auto measured = noise.measure(kStep);
  EXPECT_EQ(measured.T_previous_robot.vector(), kStep.vector());
  EXPECT_GT(measured.covariance.diagonal().minCoeff(), 0.0);
}

TEST(OdometryNoise, meanAndSpreadAreAsConfigured) {
  OdometryOptions options;
  options.scale = 0.03;
  options.turn_bias_per_m = radians(1.0);
  options.turn_scale = 0.02;
  OdometryNoise noise(options, 3);
  const int count = 20000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d v = noise.measure(kStep).T_previous_robot.vector();
    sum += v;
    squares += v * v.transpose();
  }
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d spread = squares / count - mean * mean.transpose();
  EXPECT_NEAR(mean.x(), 0.103, 1e-4);
  EXPECT_NEAR(mean.y(), 0.0, 5e-5);
  EXPECT_NEAR(mean.z(), radians(2.0 * 1.02 + 0.1), radians(0.02));
  EXPECT_NEAR(std::sqrt(spread(0, 0)), options.forward_noise_m * std::sqrt(0.1), 1e-4);
  EXPECT_NEAR(std::sqrt(spread(1, 1)), options.sideways_noise_m * std::sqrt(0.1), 5e-5);
  const double turn = std::hypot(options.turn_noise_per_m * std::sqrt(0.1),
                                 options.turn_noise_per_rad * std::sqrt(radians(2.0)));
  EXPECT_NEAR(std::sqrt(spread(2, 2)), turn, 0.03 * turn);
}

TEST(OdometryNoise, randomErrorDoesNotDependOnTheRate) {
  // Ten short steps spread as much as one long one.
  OdometryOptions options = perfect();
  options.forward_noise_m = 0.01;
  OdometryNoise noise(options, 5);
  const auto spreadOf = [&](int steps) {
    double squares = 0.0;
    const int runs = 4000;
    for (int run = 0; run < runs; ++run) {
      double x = 0.0;
      for (int i = 0; i < steps; ++i) x += noise.measure({1.0 / steps, 0, 0}).T_previous_robot.x;
      squares += (x - 1.0) * (x - 1.0);
    }
    return std::sqrt(squares / runs);
  };
  EXPECT_NEAR(spreadOf(1), 0.01, 0.0005);
  EXPECT_NEAR(spreadOf(10), 0.01, 0.0005);
}

TEST(OdometryNoise, statedCovarianceCoversTheErrorOfAMetre) {
  OdometryOptions options;
  OdometryNoise noise(options, 11);
  double squares = 0.0, stated = 0.0;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    double error = 0.0;
    for (int i = 0; i < 10; ++i) {
      const auto measured = noise.measure({0.1, 0, 0});
      error += measured.T_previous_robot.x - 0.1;
      stated += measured.covariance(0, 0);
    }
    squares += error * error;
  }
  EXPECT_NEAR(squares / stated, 1.0, 0.15);
}

}  // namespace
}  // namespace colonnade
