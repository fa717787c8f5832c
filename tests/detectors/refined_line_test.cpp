// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/refined_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade::testing {
namespace {

/// Dark below the line v = 120 + slope (u - 160), which bends by `bend` at u = 200.
RefinedLines linesOf(double slope, double bend) {
  cv::Mat gray(240, 320, CV_8UC1);
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u) {
      const double edge = 120.0 + slope * (u - 160) + bend * std::max(0, u - 200);
      gray.at<std::uint8_t>(v, u) =
          cv::saturate_cast<std::uint8_t>(60.0 + 100.0 * std::clamp(edge - v + 0.5, 0.0, 1.0));
    }
  cv::GaussianBlur(gray, gray, {0, 0}, 0.7);
  return refineLines(gray, makeEdgeLineBackend("opencv", {})->extract(gray), {});
}

TEST(RefinedLines, AStraightEdgeStaysOne) {
  const auto lines = linesOf(0.25, 0.0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_GT(lines[0].end - lines[0].begin, 250.0);
  EXPECT_NEAR(lines[0].slope, 0.25, 0.002);
}

TEST(RefinedLines, TwoStraightPartsAreNotOneSlantingLine) {
  // By 1.7 degrees, as the feet of a wall and of a door some centimetres farther back.
  const auto lines = linesOf(0.25, 0.03);
  ASSERT_EQ(lines.size(), 2U);
  for (const auto& line : lines) {
    const bool left = line.begin < 100.0;
    EXPECT_NEAR(line.slope, left ? 0.25 : 0.28, 0.004);
    EXPECT_NEAR(left ? line.end : line.begin, 200.0, 15.0);
  }
}

}  // namespace
}  // namespace colonnade::testing
