// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/floor_score.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "folder_test.hpp"

namespace colonnade {
namespace {

using ::testing::HasSubstr;

/// All free, its lower left corner at (x, y).
FloorMap rectangle(int width, int height, double x, double y, double resolution_m = 0.1) {
  FloorMap map;
  map.width = width;
  map.height = height;
  map.resolution_m = resolution_m;
  map.T_world_corner = {x, y, 0.0};
  map.free.assign(static_cast<std::size_t>(width * height), 1);
  return map;
}

TEST(FloorScore, CountsTheHandComputedAreas) {
  // 4 m x 2 m true, 3 m x 2 m mapped, 2 m x 1 m in both.
  const auto score = scoreFloor(rectangle(30, 20, 2.0, 1.0), rectangle(40, 20, 0.0, 0.0), {});
  EXPECT_NEAR(score.truth_m2, 8.0, 1e-9);
  EXPECT_NEAR(score.estimate_m2, 6.0, 1e-9);
  EXPECT_NEAR(score.both_m2, 2.0, 1e-9);
  EXPECT_NEAR(score.iou, 2.0 / 12.0, 1e-9);
  EXPECT_NEAR(score.precision, 2.0 / 6.0, 1e-9);
  EXPECT_NEAR(score.recall, 2.0 / 8.0, 1e-9);
}

TEST(FloorScore, ResamplesAtTheResolutionOfTheTruth) {
  const auto score = scoreFloor(rectangle(80, 40, 0.0, 0.0, 0.05), rectangle(40, 20, 0.0, 0.0), {});
  EXPECT_DOUBLE_EQ(score.iou, 1.0);
  EXPECT_DOUBLE_EQ(score.resolution_m, 0.1);
}

TEST(FloorScore, TakesTheAlignment) {
  // The same rectangle, a quarter turn and a shift away.
  const auto truth = rectangle(40, 20, 0.0, 0.0);
  const auto estimate = rectangle(20, 40, 5.0, 3.0);
  const Pose2 T_truth_estimate = Pose2{4.0, 0.0, kPi / 2.0} * Pose2{-5.0, -3.0, 0.0};
  EXPECT_NEAR(scoreFloor(estimate, truth, T_truth_estimate).iou, 1.0, 1e-9);
  // Turned in the file instead.
  auto turned = rectangle(20, 40, 0.0, 0.0);
  turned.T_world_corner = {4.0, 0.0, kPi / 2.0};
  EXPECT_NEAR(scoreFloor(turned, truth, {}).iou, 1.0, 1e-9);
}

TEST(FloorScore, RefusesWhatDoesNotOverlap) {
  EXPECT_THROW(scoreFloor(rectangle(10, 10, 50, 50), rectangle(10, 10, 0, 0), {}), Error);
}

class FloorMapFile : public testing::FolderTest {
 protected:
  /// Two columns, three rows as a plain PGM: free above, unknown, wall.
  void writeMap(const std::string& yaml, const std::string& cells = "254 254 205 254 0 0") {
    std::ofstream(folder_ / "m.pgm") << "P2\n2 3\n255\n" << cells << "\n";
    std::ofstream(folder_ / "m.yaml") << yaml;
  }
  std::string readError() const {
    try {
      readFloorMap(folder_ / "m.yaml");
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(FloorMapFile, IsReadAsNavigationProgramsReadIt) {
  writeMap(
      "# a map\nimage: m.pgm\nresolution: 0.5\norigin: [-1.5, 2, 0.0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const FloorMap map = readFloorMap(folder_ / "m.yaml");
  EXPECT_EQ(map.width, 2);
  EXPECT_EQ(map.height, 3);
  EXPECT_DOUBLE_EQ(map.resolution_m, 0.5);
  EXPECT_DOUBLE_EQ(map.T_world_corner.x, -1.5);
  EXPECT_EQ(map.freeCells(), 3U);
  EXPECT_TRUE(map.isFree(0, 2));  // the first row of the picture is the one of largest y
  EXPECT_FALSE(map.isFree(0, 1));
  EXPECT_FALSE(map.isFree(0, 0));
  EXPECT_FALSE(map.isFree(-1, 2));
  writeMap("image: m.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 1\nfree_thresh: 0.196\n");
  EXPECT_EQ(readFloorMap(folder_ / "m.yaml").freeCells(), 2U);
}

TEST_F(FloorMapFile, SaysWhatIsWrong) {
  EXPECT_THAT(readError(), HasSubstr("m.yaml: cannot be read"));
  writeMap("image: m.pgm\norigin: [0, 0, 0]\n");
  EXPECT_THAT(readError(), HasSubstr("\"resolution\" is missing"));
  writeMap("image: m.pgm\nresolution: fine\norigin: [0, 0, 0]\n");
  EXPECT_THAT(readError(), HasSubstr("resolution: \"fine\" is not a number"));
  writeMap("image: m.pgm\nresolution: 0.1\norigin: [0, 0]\n");
  EXPECT_THAT(readError(), HasSubstr("is not [x, y, yaw]"));
  writeMap("image: absent.png\nresolution: 0.1\norigin: [0, 0, 0]\n");
  EXPECT_THAT(readError(), HasSubstr("absent.png is missing"));
  writeMap("image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n", "205 205 205 205 0 0");
  EXPECT_THAT(readError(), HasSubstr("holds no free cell"));
  writeMap("image: m.yaml\nresolution: 0.1\norigin: [0, 0, 0]\n");
  EXPECT_THAT(readError(), HasSubstr("cannot be read as a picture"));
}

}  // namespace
}  // namespace colonnade
