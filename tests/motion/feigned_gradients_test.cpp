// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "residuals.hpp"
#include "rgbd_pyramid.hpp"

namespace colonnade {
namespace {

constexpr float kWall_m = 1.4F;
constexpr double kRatio = 4.0;

/// A wall straight ahead with a pattern on it, and the noise of a picture.
RgbdPyramid wall(const std::function<double(int, int)>& brightness, unsigned seed,
                 double noise_sigma) {
  Frame frame;
  frame.camera = PinholeCamera{320, 240, 265.0, 265.0, 159.5, 119.5};
  frame.depth_m = cv::Mat(240, 320, CV_32FC1, cv::Scalar(kWall_m));
  frame.gray.create(240, 320, CV_8UC1);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_sigma);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      frame.gray.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(std::clamp(brightness(u, v) + noise(random), 0.0, 255.0));
  return makePyramid(frame, 1);
}

NormalEquations equationsOf(const std::function<double(int, int)>& brightness, double ratio,
                            double noise_sigma = 1.5) {
  const RgbdPyramid key = wall(brightness, 1, noise_sigma), now = wall(brightness, 2, noise_sigma);
  ResidualBuffer buffer;
  return photometricEquations(selectPhotometricPoints(key.levels[0], 4, 3.0F), now.levels[0], {},
                              0.0, ratio, buffer);
}

/// About the place across and down, turns known.
Eigen::Vector2d placeInformation(const NormalEquations& equations) {
  return equations.H.diagonal().head<2>();
}

TEST(FeignedGradients, StripesTellNothingAlongThem) {
  const auto stripes = [](int, int v) { return 60.0 + 20.0 * std::sin(0.3 * v); };
  const Eigen::Vector2d feigned = placeInformation(equationsOf(stripes, 0.0));
  const Eigen::Vector2d kept = placeInformation(equationsOf(stripes, kRatio));
  EXPECT_GT(feigned.x(), 1.0 / (0.002 * 0.002));  // noise alone, surer than 2 mm
  EXPECT_LT(kept.x(), 0.05 * feigned.x());
  EXPECT_GT(kept.y(), 0.9 * feigned.y());
}

TEST(FeignedGradients, NorDoTheyInAPictureTwiceAsNoisy) {
  const auto stripes = [](int, int v) { return 60.0 + 20.0 * std::sin(0.3 * v); };
  const Eigen::Vector2d feigned = placeInformation(equationsOf(stripes, 0.0, 3.0));
  const Eigen::Vector2d kept = placeInformation(equationsOf(stripes, kRatio, 3.0));
  EXPECT_LT(kept.x(), 0.012 * feigned.x());
  EXPECT_GT(kept.y(), 0.9 * feigned.y());
}

TEST(FeignedGradients, APatternKeepsAllItTells) {
  const auto pattern = [](int u, int v) {
    return 60.0 + 20.0 * std::sin(0.3 * v) + 20.0 * std::sin(0.31 * u + 0.002 * u * v);
  };
  const NormalEquations all = equationsOf(pattern, 0.0), kept = equationsOf(pattern, kRatio);
  const Eigen::Vector2d told = placeInformation(all), still = placeInformation(kept);
  EXPECT_GT(still.x(), 0.98 * told.x());
  EXPECT_GT(still.y(), 0.98 * told.y());
}

/// The change of brightness must not know more of a weak direction than is left of it.
TEST(FeignedGradients, WhatIsLeftIsAnInformationMatrix) {
  NormalEquations equations;
  equations.H = Matrix8::Identity();
  equations.H(0, 6) = equations.H(6, 0) = 0.9;
  equations.g = equations.H.col(0) + equations.H.col(6);
  equations.count = 1;
  suppressWeakDirections(Matrix6::Identity(), kRatio, equations);
  EXPECT_LT(equations.H(0, 0), 0.01);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix8>(equations.H).eigenvalues()(0), 0.0);
  // The solution stays where it was: H x = g.
  const Vector8 x = Vector8::Unit(0) + Vector8::Unit(6);
  EXPECT_NEAR((equations.H * x - equations.g).head<6>().norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace colonnade
