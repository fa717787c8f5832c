// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "across_profile.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>

#include "pillar_consensus.hpp"

namespace colonnade::testing {
namespace {

constexpr int kColumn = 60;

/// Upright line at kColumn of an image whose gray level depends on the column alone, blurred; or a
/// flat one at that row of the image turned.
AcrossProfile profileOf(const std::function<double(int)>& gray_at, double blur_px = 0.8,
                        bool steep = true) {
  cv::Mat gray(100, 120, CV_8UC1);
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u)
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(gray_at(u));
  cv::GaussianBlur(gray, gray, {0, 0}, blur_px);
  RefinedLine line;
  line.middle = 50.0;
  line.offset = kColumn;
  line.begin = 10.0;
  line.end = 90.0;
  line.gradient_sign = 1;
  line.steep = steep;
  if (!steep) gray = gray.t();
  return {gray, line};
}

double step(int u) { return u < kColumn ? 80.0 : 140.0; }
double shade(int u) { return 80.0 + 60.0 * std::clamp((u - kColumn + 6) / 12.0, 0.0, 1.0); }
/// Darker than both sides over `width_px` up to the line.
std::function<double(int)> darkLine(int width_px, double left = 140.0) {
  return [=](int u) { return u >= kColumn ? 140.0 : (u >= kColumn - width_px ? 60.0 : left); };
}

TEST(AcrossProfile, TwoEdgesSideBySideAreWideButSteep) {
  const auto two = [](int u) { return u < kColumn - 1 ? 80.0 : (u < kColumn + 1 ? 110.0 : 140.0); };
  EXPECT_GT(profileOf(two).width(), 1.3 * profileOf(step).width());
  EXPECT_GT(profileOf(two).steepest(), 9.0);
  EXPECT_LT(profileOf(shade).steepest(), 9.0);
}

TEST(AcrossProfile, AShadeIsWiderThanAnEdge) {
  const double sharp = profileOf(step).width();
  EXPECT_GT(sharp, 1.0);
  EXPECT_LT(sharp, 3.0);
  EXPECT_GT(profileOf(shade).width(), 2.0 * sharp);
  EXPECT_GT(profileOf(step, 2.0).width(), 1.5 * sharp);  // blur widens all edges
}

TEST(AcrossProfile, ALineOfPaintHasTheSameShadeOnBothSides) {
  EXPECT_TRUE(profileOf(darkLine(4)).isThinLine(6));
  EXPECT_FALSE(profileOf(darkLine(12)).isThinLine(6));       // wider than that
  EXPECT_FALSE(profileOf(darkLine(4, 70.0)).isThinLine(6));  // another shade beyond it
  EXPECT_FALSE(profileOf(step).isThinLine(6));
}

TEST(AcrossProfile, FlatLinesAreMeasuredAsUprightOnes) {
  const auto flat = [](const std::function<double(int)>& gray_at) {
    return profileOf(gray_at, 0.8, false);
  };
  EXPECT_DOUBLE_EQ(flat(step).width(), profileOf(step).width());
  EXPECT_DOUBLE_EQ(flat(shade).steepest(), profileOf(shade).steepest());
  EXPECT_TRUE(flat(darkLine(4)).isThinLine(6));
  EXPECT_FALSE(flat(darkLine(4, 70.0)).isThinLine(6));
}

TEST(CommonWidth, IsThatOfTheEdgesOfTheFrame) {
  const AcrossProfile sharp = profileOf(step), soft = profileOf(shade);
  const std::vector<AcrossProfile> frame(6, sharp);
  EXPECT_LT(sharp.width(), CommonWidth(frame).limit());
  EXPECT_GT(soft.width(), CommonWidth(frame).limit());
  // In a blurred frame an edge may be as wide as that.
  const AcrossProfile blurred = profileOf(step, 3.0);
  EXPECT_GT(blurred.width(), CommonWidth(frame).limit());
  EXPECT_LT(blurred.width(), CommonWidth(std::vector<AcrossProfile>(6, blurred)).limit());
}

TEST(CommonWidth, ThinLinesDoNotTell) {
  // A line thinner than the blur is steeper than an edge can be.
  const AcrossProfile sharp = profileOf(step, 2.0), thin = profileOf(darkLine(1), 2.0);
  ASSERT_LT(thin.width(), 0.9 * sharp.width());
  std::vector<AcrossProfile> frame(12, thin);
  EXPECT_LT(sharp.width(), CommonWidth(frame).limit());
  frame.insert(frame.end(), 5, sharp);
  EXPECT_LT(sharp.width(), CommonWidth(frame).limit());
}

}  // namespace
}  // namespace colonnade::testing
