// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_walker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace colonnade::testing {
namespace {

cv::Mat randomBytes(std::mt19937& random, int rows, int columns, unsigned most) {
  cv::Mat image(rows, columns, CV_8UC1);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
      image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(random() % (most + 1));
  return image;
}

/// Codes of edges as EdgeLines::edges, most of them none.
cv::Mat randomEdges(std::mt19937& random, int rows, int columns) {
  cv::Mat edges = randomBytes(random, rows, columns, 40);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
      if (edges.at<std::uint8_t>(v, u) > 8) edges.at<std::uint8_t>(v, u) = 0;
  return edges;
}

/// Sectors 0 and 4 point along +u and -u, 2 and 6 along +v and -v.
bool pointsAcross(int code, bool steep, int sign) {
  if (code == 0) return false;
  const int ahead = (steep ? 0 : 2) + (sign > 0 ? 0 : 4);
  const int turn = (code - 1 - ahead + 8) % 8;
  return turn == 0 || turn == 1 || turn == 7;
}

TEST(StepBits, AreThoseOfTheEdges) {
  std::mt19937 random(1);
  for (const auto& [rows, columns] : {std::pair(1, 1), {9, 16}, {17, 31}, {40, 130}, {130, 40}}) {
    const cv::Mat edges = randomEdges(random, rows, columns);
    const BitsOfBoth both = bitsOfBoth(edges);
    EdgeBits again{{rows, columns}, {rows, columns}};
    for (int v = 0; v < rows; ++v) {
      setSteepBits(edges.ptr<std::uint8_t>(v), columns, v, again);
      std::vector<bool> each(static_cast<std::size_t>(columns), false);
      both.steep.rising.each(v, [&](int u) { each[static_cast<std::size_t>(u)] = true; });
      for (int u = 0; u < columns; ++u) {
        const int code = edges.at<std::uint8_t>(v, u);
        EXPECT_EQ(both.steep.rising.test(v, u), pointsAcross(code, true, 1));
        EXPECT_EQ(both.steep.falling.test(v, u), pointsAcross(code, true, -1));
        EXPECT_EQ(both.flat.rising.test(u, v), pointsAcross(code, false, 1));
        EXPECT_EQ(both.flat.falling.test(u, v), pointsAcross(code, false, -1));
        EXPECT_EQ(again.rising.test(v, u), pointsAcross(code, true, 1));
        EXPECT_EQ(again.falling.test(v, u), pointsAcross(code, true, -1));
        EXPECT_EQ(each[static_cast<std::size_t>(u)], pointsAcross(code, true, 1));
      }
    }
  }
}

/// Vertex of the parabola through three gradient magnitudes across, in plain words.
double expectedAcross(const cv::Mat& gray, bool steep, int s, int t) {
  const auto at = [&](int along, int across) -> int {
    return steep ? gray.at<std::uint8_t>(s + along, t + across)
                 : gray.at<std::uint8_t>(t + across, s + along);
  };
  const auto smooth = [&](int across) {
    return at(-1, across) + 2 * at(0, across) + at(1, across);
  };
  const int before = std::abs(smooth(0) - smooth(-2)), here = std::abs(smooth(1) - smooth(-1)),
            after = std::abs(smooth(2) - smooth(0));
  const int curvature = before - 2 * here + after;
  return t + (curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0);
}

TEST(Walker, MeasuresEveryPixelByItsParabola) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> slopes(-0.9, 0.9);
  for (int round = 0; round < 60; ++round) {
    const int rows = 12 + static_cast<int>(random() % 80);
    const int columns = 12 + static_cast<int>(random() % 80);
    // Smooth in places, so that some parabolas have no vertex.
    const cv::Mat gray = randomBytes(random, rows, columns, round % 2 == 0 ? 255 : 1);
    const cv::Mat edges = randomEdges(random, rows, columns);
    const BitsOfBoth both = bitsOfBoth(edges);
    for (const bool steep : {true, false}) {
      Walker walker(gray, edges, steep ? both.steep : both.flat, steep);
      const int length = steep ? rows : columns, width = steep ? columns : rows;
      Samples samples(walker.steps());
      walker.collectAll({0.5 * length, 0.5 * width, slopes(random)}, 10.0, 1, samples);
      walker.measure(samples);
      const SampleSpan all = samples;
      EXPECT_GT(all.size(), 0U);
      for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_EQ(all.across[i], expectedAcross(gray, steep, static_cast<int>(all.s[i]), all.t[i]));
    }
  }
}

Samples samplesOf(const std::vector<double>& across) {
  Samples samples(static_cast<int>(across.size()));
  for (std::size_t i = 0; i < across.size(); ++i) {
    samples.add(static_cast<int>(i), static_cast<int>(across[i]));
    samples.across()[i] = across[i];
  }
  return samples;
}

TEST(Samples, AreKeptWithinReachOfALine) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.3);
  for (int count = 0; count < 200; ++count) {
    std::vector<double> across;
    for (int i = 0; i < count; ++i)
      across.push_back(20.0 + 0.1 * i + (i % 97 < 40 ? 0.0 : noise(random)));
    Samples samples = samplesOf(across);
    const Straight line{0.0, 20.0, 0.1};
    samples.assignWithin(samples, line, 0.25);
    std::size_t kept = 0;
    const SampleSpan all = samples;
    for (std::size_t i = 0; i < across.size(); ++i) {
      if (std::abs(across[i] - line.across(static_cast<double>(i))) > 0.25) continue;
      ASSERT_LT(kept, all.size());
      EXPECT_EQ(all.s[kept], static_cast<double>(i));
      EXPECT_EQ(all.across[kept], across[i]);
      EXPECT_EQ(all.t[kept], static_cast<int>(across[i]));
      ++kept;
    }
    EXPECT_EQ(kept, all.size());
  }
}

}  // namespace
}  // namespace colonnade::testing
