// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "colonnade/simulation/colour_noise.hpp"
#include "colonnade/simulation/depth_noise.hpp"

namespace colonnade {
namespace {

PinholeCamera camera() { return CameraOptions{}.pinhole(); }

/// Depth that grows slowly from left to right, so that the steps of disparity average out.
cv::Mat slope(double z, double growth) {
  cv::Mat depth(240, 320, CV_32FC1);
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      depth.at<float>(row, column) = static_cast<float>(z + growth * column / depth.cols);
    }
  }
  return depth;
}

TEST(DepthNoise, spreadFollowsTheKinectModel) {
  for (const double z : {1.0, 2.0, 3.5, 5.0}) {
    const cv::Mat truth = slope(z, 0.2);
    DepthNoise noise({}, camera(), 1);
    const cv::Mat measured = noise.measure(truth);
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (int row = 0; row < truth.rows; ++row) {
      for (int column = 0; column < truth.cols; ++column) {
        if (measured.at<float>(row, column) == 0.0F) continue;
        const double error = measured.at<float>(row, column) - truth.at<float>(row, column);
        sum += error;
        squares += error * error;
        ++count;
      }
    }
    const double sigma = 0.0012 + 0.0019 * std::pow(z + 0.1 - 0.4, 2);
    EXPECT_GT(count, 0.95 * 320 * 240);
    EXPECT_NEAR(sum / count, 0.0, 0.15 * sigma) << z;
    EXPECT_NEAR(std::sqrt(squares / count), sigma, 0.2 * sigma) << z;
  }
}

TEST(DepthNoise, givesWholeMillimetresWithinTheRange) {
  DepthNoise noise({}, camera(), 1);
  const cv::Mat measured = noise.measure(slope(0.2, 8.0));
  for (int column = 0; column < measured.cols; ++column) {
    const double z = measured.at<float>(120, column);
    if (z == 0.0) continue;
    EXPECT_GE(z, 0.5 - 1e-6);
    EXPECT_LE(z, 6.0 + 1e-6);
    EXPECT_NEAR(1000.0 * z, std::round(1000.0 * z), 1e-3);
  }
  EXPECT_EQ(measured.at<float>(120, 2), 0.0F);    // too near
  EXPECT_EQ(measured.at<float>(120, 310), 0.0F);  // too far
  EXPECT_GT(cv::countNonZero(measured.colRange(60, 200)), 0.9 * 140 * 240);
}

TEST(DepthNoise, aNearObjectCastsAShadowAwayFromTheProjector) {
  DepthOptions options;
  options.loss_fraction = 0.0;
  cv::Mat truth(240, 320, CV_32FC1, cv::Scalar(4.0));
  truth.colRange(150, 170).setTo(1.0);
  const cv::Mat measured = DepthNoise(options, camera(), 1).measure(truth);
  // b f (1/z_near - 1/z_far) pixels wide, left of the object.
  const double width = 0.075 * camera().fx_px * (1.0 - 0.25);
  const int dark = static_cast<int>(width) - 2;
  EXPECT_EQ(cv::countNonZero(measured.colRange(149 - dark, 149)), 0);
  EXPECT_EQ(cv::countNonZero(measured.colRange(100, 145 - dark)), 240 * (45 - dark));
  EXPECT_EQ(cv::countNonZero(measured.colRange(173, 220)), 240 * 47);
}

TEST(DepthNoise, surfacesSeenAtAGrazingAngleAreLost) {
  // A floor: z grows towards the horizon, seen at 2 degrees only near it.
  const auto lens = camera();
  cv::Mat truth = cv::Mat::zeros(240, 320, CV_32FC1);
  const double height_m = 0.2;
  for (int row = 130; row < 240; ++row) {
    truth.row(row).setTo(height_m * lens.fy_px / (row - lens.cy_px));
  }
  const cv::Mat measured = DepthNoise({}, lens, 1).measure(truth);
  EXPECT_EQ(cv::countNonZero(measured.row(132)), 0);  // 5.8 m or farther, about 2.5 degrees
  EXPECT_GT(cv::countNonZero(measured.row(200)), 300);
}

TEST(ColourNoise, keepsTheMeanAndHasTheStatedSpread) {
  ColourOptions options;
  options.vignetting = options.exposure_noise = 0.0;
  ColourNoise noise(options, 1);
  const cv::Mat flat(240, 320, CV_8UC3, cv::Scalar::all(100));
  cv::Scalar mean, sigma;
  cv::meanStdDev(noise.measure(flat), mean, sigma);
  const double expected = std::sqrt(1.5 * 1.5 + 0.12 * 0.12 * 100.0);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(mean[channel], 100.0, 0.1);
    EXPECT_NEAR(sigma[channel], expected, 0.06);
  }
}

TEST(ColourNoise, cornersAreDarker) {
  ColourOptions options;
  options.vignetting = 0.3;
  options.read_noise = options.shot_noise = options.exposure_noise = 0.0;
  const cv::Mat out =
      ColourNoise(options, 1).measure(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(200)));
  EXPECT_EQ(out.at<cv::Vec3b>(120, 160)[0], 200);
  EXPECT_NEAR(out.at<cv::Vec3b>(0, 0)[0], 140, 1);
}

}  // namespace
}  // namespace colonnade
