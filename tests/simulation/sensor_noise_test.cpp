// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <vector>

#include "colonnade/simulation/colour_noise.hpp"
#include "colonnade/simulation/depth_noise.hpp"
#include "colonnade/simulation/light_schedule.hpp"

namespace colonnade {
namespace {

PinholeCamera camera() { return CameraOptions{}.pinhole(); }

/// The perfect depth of a wall: along the optical axis at distance z, turned by `angle` about the
/// vertical.
cv::Mat wall(double z, double angle = 0.0) {
  const auto lens = camera();
  cv::Mat depth(lens.height_px, lens.width_px, CV_32FC1);
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      const double x = (column - lens.cx_px) / lens.fx_px;
      depth.at<float>(row, column) = static_cast<float>(z / (1.0 - x * std::tan(angle)));
    }
  }
  return depth;
}

struct Spread {
  double mean = 0.0, sigma = 0.0;
  int count = 0;
};

/// Of measured millimetres about true metres, `frames` frames together.
Spread spreadOf(DepthNoise& noise, const cv::Mat& truth, int frames) {
  Spread spread;
  double sum = 0.0, squares = 0.0;
  for (int frame = 0; frame < frames; ++frame) {
    const cv::Mat measured = noise.measure(truth);
    for (int row = 0; row < truth.rows; ++row) {
      for (int column = 0; column < truth.cols; ++column) {
        if (measured.at<std::uint16_t>(row, column) == 0) continue;
        const double error = 0.001 * measured.at<std::uint16_t>(row, column) -
                             static_cast<double>(truth.at<float>(row, column));
        sum += error;
        squares += error * error;
        ++spread.count;
      }
    }
  }
  spread.mean = sum / spread.count;
  spread.sigma = std::sqrt(squares / spread.count - spread.mean * spread.mean);
  return spread;
}

TEST(DepthNoise, spreadOnAWallFollowsTheKinectModel) {
  for (const double z : {1.0, 2.0, 3.0, 4.0}) {
    DepthNoise noise({}, camera(), 1);
    const auto spread = spreadOf(noise, wall(z), 3);
    const double sigma = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    EXPECT_GT(spread.count, 0.99 * 3 * 320 * 240);
    EXPECT_NEAR(spread.mean, 0.0, 0.1 * sigma) << z;
    EXPECT_NEAR(spread.sigma, sigma, 0.1 * sigma) << z;
  }
}

TEST(DepthNoise, aSlantedWallIsNoEdgeAndGrazingNoiseGrowsWithTheAngle) {
  DepthOptions options;
  options.noise_grazing_m = 0.0001;
  options.lateral_px = options.lateral_grazing_px = 0.0;
  const auto growthAt = [&](double angle) {
    DepthNoise noise(options, camera(), 1);
    const cv::Mat truth = wall(2.0, angle);
    const cv::Mat middle = truth(cv::Rect(155, 0, 10, 240));
    const cv::Mat measured = noise.measure(truth)(cv::Rect(155, 0, 10, 240));
    double squares = 0.0;
    int count = 0;
    for (int row = 0; row < middle.rows; ++row) {
      for (int column = 0; column < middle.cols; ++column) {
        if (measured.at<std::uint16_t>(row, column) == 0) continue;
        const double error = 0.001 * measured.at<std::uint16_t>(row, column) -
                             static_cast<double>(middle.at<float>(row, column));
        squares += error * error;
        ++count;
      }
    }
    EXPECT_GT(count, 0.98 * 10 * 240) << angle;
    return std::sqrt(squares / count);
  };
  // theta / (pi/2 - theta) = 7 at 78.75 degrees: 0.0001 / sqrt(2) * 49 m on top of 6.1 mm.
  EXPECT_NEAR(growthAt(0.0), 0.0061, 0.0008);
  EXPECT_NEAR(growthAt(radians(78.75)), 0.0061 + 0.0035, 0.0012);
}

TEST(DepthNoise, givesWholeMillimetresWithinTheRange) {
  cv::Mat truth(240, 320, CV_32FC1);
  for (int column = 0; column < truth.cols; ++column) {
    truth.col(column).setTo(0.2 + 8.0 * column / truth.cols);
  }
  DepthOptions options;
  options.baseline_m = 0.0;  // such a surface shades itself
  const cv::Mat measured = DepthNoise(options, camera(), 1).measure(truth);
  ASSERT_EQ(measured.type(), CV_16UC1);
  for (int column = 0; column < measured.cols; ++column) {
    const int z = measured.at<std::uint16_t>(120, column);
    if (z == 0) continue;
    EXPECT_GE(z, 500);
    EXPECT_LE(z, 6000);
  }
  EXPECT_EQ(measured.at<std::uint16_t>(120, 2), 0);    // too near
  EXPECT_EQ(measured.at<std::uint16_t>(120, 310), 0);  // too far
  EXPECT_GT(cv::countNonZero(measured.colRange(60, 200)), 0.9 * 140 * 240);
}

TEST(DepthNoise, disparityComesInWholeSteps) {
  const cv::Mat measured = DepthNoise({}, camera(), 1).measure(wall(4.0));
  const double gain = 2.0 * camera().fx_px * 0.075 * 8.0;  // eighths of a pixel of 640
  for (int column = 0; column < measured.cols; column += 3) {
    const int z = measured.at<std::uint16_t>(100, column);
    if (z == 0) continue;
    const double steps = gain / (0.001 * z);
    EXPECT_NEAR(steps, std::round(steps), 0.02);  // half a millimetre is 0.01 steps
  }
}

/// Per row, where depth changes from a near surface (left of column 160) to a far one.
TEST(DepthNoise, outlinesFrayByTheLateralNoise) {
  DepthOptions options;
  options.loss_fraction = options.edge_loss_fraction = 0.0;
  options.baseline_m = 0.0;
  CameraOptions wide;
  wide.width_px = 640, wide.height_px = 480;
  cv::Mat truth(480, 640, CV_32FC1, cv::Scalar(3.0));
  truth.colRange(0, 320).setTo(1.5);
  const auto rowsOfEdges = [&](const DepthOptions& o) {
    DepthNoise noise(o, wide.pinhole(), 1);
    double sum = 0.0, squares = 0.0;
    int rows = 0;
    for (int frame = 0; frame < 2; ++frame) {
      const cv::Mat measured = noise.measure(truth);
      for (int row = 0; row < 480; ++row, ++rows) {
        int near = 0;  // pixels on the near surface
        for (int column = 300; column < 340; ++column) {
          near += measured.at<std::uint16_t>(row, column) < 2200;
        }
        sum += near, squares += near * near;
      }
    }
    return std::sqrt(squares / rows - (sum / rows) * (sum / rows));
  };
  EXPECT_NEAR(rowsOfEdges(options), 0.8, 0.25);
  options.lateral_px = options.lateral_grazing_px = 0.0;
  EXPECT_EQ(rowsOfEdges(options), 0.0);
}

TEST(DepthNoise, glassAndMirrorsGiveNoDepth) {
  cv::Mat no_return = cv::Mat::zeros(240, 320, CV_8UC1);
  no_return(cv::Rect(100, 50, 80, 60)).setTo(255);
  const cv::Mat measured = DepthNoise({}, camera(), 1).measure(wall(2.0), no_return);
  EXPECT_EQ(cv::countNonZero(measured(cv::Rect(100, 50, 80, 60))), 0);
  EXPECT_GT(cv::countNonZero(measured(cv::Rect(200, 50, 80, 60))), 0.98 * 80 * 60);
}

TEST(DepthNoise, aNearObjectCastsAShadowAwayFromTheProjector) {
  DepthOptions options;
  options.loss_fraction = options.edge_loss_fraction = options.lateral_px = 0.0;
  options.lateral_grazing_px = 0.0;
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

TEST(ColourNoise, autoExposureFollowsTheLightWithALag) {
  ColourOptions options;
  options.auto_exposure = true;
  options.exposure_noise = 0.0;
  options.exposure_target = 100.0;
  options.exposure_lag_s = 0.5;
  ColourNoise noise(options, 1);
  const cv::Mat scene(120, 160, CV_8UC3, cv::Scalar::all(200));
  const Eigen::Vector3d dusk = Eigen::Vector3d::Constant(0.25);
  noise.measure(scene);
  EXPECT_NEAR(noise.gain(), 0.5, 0.01);
  noise.measure(scene, dusk, 0.1);  // it has not noticed yet
  EXPECT_NEAR(noise.gain(), 0.5, 0.01);
  noise.measure(scene, dusk, 0.5);  // one time constant later: 63 % of the way to 2
  EXPECT_NEAR(noise.gain(), 0.5 + 1.5 * (1.0 - std::exp(-1.0)), 0.02);
  for (int i = 0; i < 10; ++i) noise.measure(scene, dusk, 0.5);
  EXPECT_NEAR(noise.gain(), 2.0, 0.01);
}

TEST(ColourNoise, withoutAutoExposureDuskIsDarkAndTinted) {
  ColourOptions options;
  options.vignetting = options.exposure_noise = 0.0;
  const cv::Mat scene(120, 160, CV_8UC3, cv::Scalar::all(200));
  const auto mean = cv::mean(ColourNoise(options, 1).measure(scene, {0.5, 0.4, 0.2}));
  EXPECT_NEAR(mean[2], 100.0, 0.3);  // red
  EXPECT_NEAR(mean[1], 80.0, 0.3);
  EXPECT_NEAR(mean[0], 40.0, 0.3);
}

TEST(ColourNoise, gainAmplifiesTheNoise) {
  ColourOptions options;
  options.vignetting = options.exposure_noise = 0.0;
  options.auto_exposure = true;
  options.exposure_target = 100.0;
  const auto sigmaAt = [&](double light) {
    cv::Scalar mean, sigma;
    const cv::Mat scene(120, 160, CV_8UC3, cv::Scalar::all(100));
    cv::meanStdDev(ColourNoise(options, 1).measure(scene, Eigen::Vector3d::Constant(light)), mean,
                   sigma);
    EXPECT_NEAR(mean[1], 100.0, 1.0);
    return sigma[1];
  };
  EXPECT_NEAR(sigmaAt(1.0), std::sqrt(1.5 * 1.5 + 0.12 * 0.12 * 100.0), 0.1);
  EXPECT_NEAR(sigmaAt(0.1), std::sqrt(15.0 * 15.0 + 10.0 * 0.12 * 0.12 * 100.0), 0.7);
}

TEST(ColourNoise, exposureWandersSlowly) {
  ColourOptions options;
  options.exposure_noise = 0.05;
  options.exposure_noise_s = 1.0;
  ColourNoise noise(options, 3);
  const cv::Mat scene(8, 8, CV_8UC3, cv::Scalar::all(100));
  double squares = 0.0, products = 0.0, before = 0.0;
  const int count = 4000;
  for (int i = 0; i < count; ++i) {
    noise.measure(scene, Eigen::Vector3d::Ones(), 0.1);
    const double deviation = noise.gain() - 1.0;
    squares += deviation * deviation;
    products += deviation * before;
    before = deviation;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.05, 0.01);
  EXPECT_NEAR(products / squares, std::exp(-0.1), 0.03);
}

TEST(LightSchedule, isLinearBetweenItsPoints) {
  LightSchedule schedule;
  EXPECT_EQ(schedule.lightAt(3.0, 4.0), Eigen::Vector3d::Ones());
  schedule.points = {{2.0, Eigen::Vector3d::Constant(1.0)}, {6.0, {0.5, 0.25, 0.0}}};
  EXPECT_EQ(schedule.lightAt(0.0, 1.0), Eigen::Vector3d::Ones());
  EXPECT_TRUE(schedule.lightAt(0.0, 4.0).isApprox(Eigen::Vector3d(0.75, 0.625, 0.5)));
  EXPECT_TRUE(schedule.lightAt(0.0, 9.0).isApprox(Eigen::Vector3d(0.5, 0.25, 0.0)));
  schedule.by_time = true;
  EXPECT_TRUE(schedule.lightAt(4.0, 0.0).isApprox(Eigen::Vector3d(0.75, 0.625, 0.5)));
}

TEST(Random, manyNormalsHaveUnitVarianceAndReachFourSigma) {
  Random random(7, "many");
  std::vector<float> values(400001);
  random.normals(values.data(), values.size());
  double sum = 0.0, squares = 0.0, products = 0.0, fourth = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double v = values[i];
    sum += v, squares += v * v, fourth += v * v * v * v;
    if (i > 0) products += v * static_cast<double>(values[i - 1]);
  }
  const auto count = static_cast<double>(values.size());
  EXPECT_NEAR(sum / count, 0.0, 0.008);
  EXPECT_NEAR(squares / count, 1.0, 0.012);
  EXPECT_NEAR(fourth / count, 3.0, 0.08);
  EXPECT_NEAR(products / count, 0.0, 0.008);
  EXPECT_GT(*std::max_element(values.begin(), values.end()), 3.9F);
  random.uniforms(values.data(), values.size());
  EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0) / count, 0.5, 0.003);
  EXPECT_LT(*std::max_element(values.begin(), values.end()), 1.0F);
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
