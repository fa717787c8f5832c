// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <opencv2/core.hpp>

#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/simulation/renderer.hpp"
#include "colonnade/simulation/simulator.hpp"
#include "temporary_folder.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

class Columns : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = whyNoRendering(); !why.empty()) GTEST_SKIP() << why;
  }
  const testing::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

/// Rows of a columns file: frame and the fields.
std::vector<std::vector<std::string>> rowsOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) rows.push_back(fields(line, ','));
  return rows;
}

TEST_F(Columns, agreeWithTheProjectedLandmarks) {
  const auto world = testing::roomWorld(
      "material concrete pattern=plain colour=60,60,60\ncamera rate_hz=3 width_px=320 "
      "height_px=240\n");
  const auto log = folder_ / "room.rawlog";
  simulate(world, log, {});
  const auto truth = readTum(folder_ / "room_ground_truth.tum");
  const auto landmarks = readLandmarksCsv(folder_ / "room_landmarks.csv");
  const auto rows = rowsOf(folder_ / "room_columns.csv");
  ASSERT_GT(rows.size(), 10U);
  EXPECT_EQ(joined(rows[0], ","), "stamp,frame,id,kind,u0,v0,u1,v1,length_px,range_m,contrast");
  const auto lens = world.camera.pinhole();
  int pilaster = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto number = [&](std::size_t field) { return *parseDouble(rows[i][field]); };
    const auto frame = static_cast<std::size_t>(number(1));
    if (rows[i][3] == "minor") continue;  // no landmark
    const auto& landmark = landmarks.at(static_cast<std::size_t>(number(2)));
    ASSERT_EQ(rows[i][3], name(landmark.kind));
    EXPECT_NEAR(number(0), truth.at(frame).stamp_s, 1e-6);
    const Eigen::Isometry3d T_camera_world =
        (truth.at(frame).T_world_body * world.camera.T_robot_camera()).inverse();
    if (landmark.kind == LandmarkKind::kFloorEdge) continue;
    // Both ends lie on the projected vertical through the landmark.
    const auto projected = [&](double z) -> Eigen::Vector2d {
      const Eigen::Vector3d p =
          T_camera_world * Eigen::Vector3d(landmark.p_world.x(), landmark.p_world.y(), z);
      return {lens.cx_px + lens.fx_px * p.x() / p.z(), lens.cy_px + lens.fy_px * p.y() / p.z()};
    };
    const Eigen::Vector2d along = (projected(1.0) - projected(0.9)).normalized();
    for (const std::size_t end : {std::size_t{4}, std::size_t{6}}) {
      const Eigen::Vector2d off = Eigen::Vector2d(number(end), number(end + 1)) - projected(1.0);
      EXPECT_LT(std::abs(off.x() * along.y() - off.y() * along.x()), 0.05);
    }
    EXPECT_LT(number(5), number(7));  // from the top
    const Eigen::Vector2d p_camera =
        (truth.at(frame).T_world_body * world.camera.T_robot_camera()).translation().head<2>();
    EXPECT_NEAR(number(9), (landmark.p_world - p_camera).norm(), 0.01);
    if (std::abs(landmark.p_world.x() - 4.8) > 1e-6) continue;
    ++pilaster;
    // The pilaster is dark. Its right edge (y = -1.2) stands before the wall, beside its left one a
    // strip of the flank shows.
    const bool right_edge = landmark.p_world.y() < -1.0;
    EXPECT_GT(right_edge ? number(10) : -number(10), right_edge ? 30.0 : 5.0);
  }
  EXPECT_EQ(pilaster, 2 * static_cast<int>(truth.size()) * 2);  // as pillar and as depth_slope
}

TEST_F(Columns, nameGlassAndPeopleAndGlassGivesNoDepth) {
  const auto world = testing::roomWorld(
      "door wall=r.2 at_m=2.8 width_m=1.0 material=glass\nwalker 3 -1.5 3 -0.6\n"
      "camera rate_hz=2\ndrive 1.5 0\n");
  const auto log = folder_ / "glass.rawlog";
  simulate(world, log, {});
  const auto rows = rowsOf(folder_ / "glass_columns.csv");
  RawlogSource source(log);
  int panes = 0, people = 0;
  std::size_t row = 1;
  while (const auto frame = source.next()) {
    for (; row < rows.size() && *parseDouble(rows[row][1]) == static_cast<double>(frame->index);
         ++row) {
      const auto number = [&](std::size_t field) {
        return static_cast<int>(*parseDouble(rows[row][field]));
      };
      if (rows[row][3] == "person") ++people;
      if (rows[row][3] != "glass") continue;
      ++panes;
      const int width = number(6) - number(4), height = number(7) - number(5);
      const cv::Rect middle(number(4) + width / 4, number(5) + height / 4, std::max(1, width / 2),
                            std::max(1, height / 2));
      EXPECT_EQ(cv::countNonZero(frame->depth_m(middle)), 0) << frame->index;
    }
  }
  EXPECT_EQ(row, rows.size());
  EXPECT_GT(panes, 4);
  EXPECT_GT(people, 2);
}

TEST_F(Columns, sayWhatEveryOtherUprightLineIs) {
  const auto world = testing::roomWorld(
      "column 3 0.6 diameter_m=0.4\nboard wall=r.2 at_m=2.2\ntable 3.4 -0.9\n"
      "cabinet 4.7 1.6 size_m=0.4,0.5\ncamera rate_hz=1 width_px=320 height_px=240\n");
  const auto log = folder_ / "things.rawlog";
  simulate(world, log, {});
  const auto truth = readTum(folder_ / "things_ground_truth.tum");
  const auto lens = world.camera.pinhole();
  std::map<std::string, int> kinds;
  const auto rows = rowsOf(folder_ / "things_columns.csv");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ++kinds[rows[i][3]];
    if (rows[i][3] != "round") continue;
    // The outline of a round pillar: a line of sight that touches the circle.
    const auto number = [&](std::size_t field) { return *parseDouble(rows[i][field]); };
    const auto& T_world_body = truth.at(static_cast<std::size_t>(number(1))).T_world_body;
    const Eigen::Isometry3d T_world_camera = T_world_body * world.camera.T_robot_camera();
    const Eigen::Vector3d ray = T_world_camera.linear() * lens.ray(number(4), number(5));
    const Eigen::Vector2d to_axis =
        Eigen::Vector2d(3.0, 0.6) - T_world_camera.translation().head<2>();
    const Eigen::Vector2d way = ray.head<2>().normalized();
    EXPECT_NEAR(0.2, std::abs(way.x() * to_axis.y() - way.y() * to_axis.x()), 0.006);
    EXPECT_NEAR(number(9), to_axis.dot(way), 0.06);
  }
  EXPECT_EQ(kinds["round"], 2 * static_cast<int>(truth.size()));
  EXPECT_GE(kinds["fixture"], 2 * static_cast<int>(truth.size()));    // the board
  EXPECT_GE(kinds["furniture"], 4 * static_cast<int>(truth.size()));  // legs
  EXPECT_GE(kinds["cabinet"], static_cast<int>(truth.size()));
}

}  // namespace
}  // namespace colonnade
