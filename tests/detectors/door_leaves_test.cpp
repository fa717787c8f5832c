// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/door_leaves.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

constexpr const char* kReason = "on the leaf of an open door";

/// A corridor, x from 0 to 3, and a room behind its wall, with an opening at y = -0.45 to 0.45.
Scene corridorAndRoom() {
  Scene scene;
  const auto wall = [&](double ax, double ay, double bx, double by) {
    scene.faces.push_back({{ax, ay}, {bx, by}, 120.0});
  };
  wall(0.0, -4.0, 0.0, 4.0);
  wall(3.0, -4.0, 3.0, -0.45);
  wall(3.0, 0.45, 3.0, 4.0);
  wall(6.5, -4.0, 6.5, 4.0);
  return scene;
}

/// The wall between them is 0.2 m thick and has a door, the leaf of which stands in the room.
Scene withOpenDoor() {
  Scene scene = corridorAndRoom();
  for (const double side : {-1.0, 1.0}) {
    scene.faces.push_back({{3.0, 0.45 * side}, {3.2, 0.45 * side}, 90.0});
    scene.faces.push_back({{3.2, 0.45 * side}, {3.2, 4.0 * side}, 140.0});
  }
  scene.faces.push_back({{3.2, 0.45}, {4.1, 0.45}, 60.0});
  return scene;
}

/// It is as thick as a leaf and a jamb together are wide: a passage.
Scene withPassage() {
  Scene scene = corridorAndRoom();
  for (const double side : {-1.0, 1.0}) {
    scene.faces.push_back({{3.0, 0.45 * side}, {4.1, 0.45 * side}, 90.0});
    scene.faces.push_back({{4.1, 0.45 * side}, {4.1, 4.0 * side}, 140.0});
  }
  return scene;
}

/// What a camera in the robot's origin that looks along its x axis sees of upright faces.
DepthProfile sliceOf(const Scene& scene, const Pose2& T_world_robot) {
  const Pose2 T_robot_world = T_world_robot.inverse();
  DepthProfile profile;
  profile.focal_px = 577.0;
  profile.R_robot_slice << 0.0, 1.0, -1.0, 0.0;
  profile.columns.resize(640);
  for (int i = 0; i < 640; ++i) {
    auto& column = profile.columns[static_cast<std::size_t>(i)];
    column.slope = (i - 319.5) / profile.focal_px;
    const Eigen::Vector2d ray(1.0, -column.slope);
    for (const Face& face : scene.faces) {
      const Eigen::Vector2d a = transform(T_robot_world, face.a);
      const Eigen::Vector2d way = transform(T_robot_world, face.b) - a;
      const double across = ray.x() * way.y() - ray.y() * way.x();
      const double z = (a.x() * way.y() - a.y() * way.x()) / across;
      const double part = (a.x() * ray.y() - a.y() * ray.x()) / across;
      if (z > 0.2 && part >= 0.0 && part <= 1.0 && (column.z == 0.0 || z < column.z)) column.z = z;
    }
  }
  return profile;
}

/// Drives through a scene and asks at each stop for the edges of which it is told.
class Drive {
 public:
  explicit Drive(Scene scene) : scene_(std::move(scene)) {}

  /// The refusals of pillar edges at places of the world, with the robot there.
  std::vector<std::string> at(const Pose2& T_world_robot,
                              const std::vector<Eigen::Vector2d>& p_world, bool known = true) {
    const Pose2 T_robot_world = T_world_robot.inverse();
    Detections edges;
    for (const auto& p : p_world) {
      const Eigen::Vector2d p_robot = transform(T_robot_world, p);
      Detection& edge = edges.emplace_back();
      edge.measurement.z = Eigen::Vector2d(bearingOf(p_robot), p_robot.norm());
      edge.measurement.R = Eigen::Matrix2d::Identity();
      edge.range_m = p_robot.norm();
    }
    const auto T_previous_robot =
        last_ && known ? std::optional(last_->inverse() * T_world_robot) : std::nullopt;
    leaves_.judge(edges, sliceOf(scene_, T_world_robot), {}, T_previous_robot);
    last_ = T_world_robot;
    std::vector<std::string> refusals;
    for (const Detection& edge : edges) refusals.push_back(edge.refusal);
    return refusals;
  }

 private:
  Scene scene_;
  DoorLeaves leaves_;
  std::optional<Pose2> last_;
};

using Refusals = std::vector<std::string>;
const Eigen::Vector2d kFreeEdge{4.1, 0.45};

TEST(DoorLeaves, TheFreeEdgeIsRefusedAndTheFrameStays) {
  Drive drive(withOpenDoor());
  drive.at({0.5, 0.0, 0.0}, {});
  drive.at({1.2, 0.0, 0.0}, {});
  EXPECT_EQ(drive.at({1.9, 0.0, 0.0}, {kFreeEdge, {3.0, 0.45}, {3.2, 0.45}, {3.0, -0.45}}),
            (Refusals{kReason, "", "", ""}));
}

TEST(DoorLeaves, WhatWasSeenToBeALeafStaysOne) {
  Drive drive(withOpenDoor());
  drive.at({0.5, 0.0, 0.0}, {});
  drive.at({1.9, 0.0, 0.0}, {kFreeEdge});
  // Only the last centimetres of it are in the picture.
  EXPECT_EQ(drive.at({3.35, 0.0, 0.0}, {kFreeEdge}), Refusals{kReason});
  // But not once it is not known where the robot is.
  EXPECT_EQ(drive.at({3.35, 0.0, 0.0}, {kFreeEdge}, false), Refusals{""});
}

TEST(DoorLeaves, TheWallThatWasSeenBeforeCounts) {
  // In the doorway neither the hinge nor the wall is in the picture.
  Drive drive(withOpenDoor());
  EXPECT_EQ(drive.at({2.7, 0.0, 0.0}, {kFreeEdge}), Refusals{""});
  Drive from_afar(withOpenDoor());
  from_afar.at({0.5, 0.0, 0.0}, {});
  from_afar.at({1.2, 0.0, 0.0}, {});
  EXPECT_EQ(from_afar.at({2.7, 0.0, 0.0}, {kFreeEdge}), Refusals{kReason});
}

TEST(DoorLeaves, TheJambSeenAlongTheLeafStays) {
  Drive drive(withOpenDoor());
  drive.at({6.2, 0.0, kPi}, {});
  EXPECT_EQ(drive.at({5.4, 0.0, kPi}, {{3.0, 0.45}}), Refusals{""});
  EXPECT_EQ(drive.at({4.6, 0.0, kPi}, {{3.0, 0.45}}), Refusals{""});
}

TEST(DoorLeaves, TheEndOfAThickWallStays) {
  Drive drive(withPassage());
  drive.at({0.5, 0.0, 0.0}, {});
  drive.at({1.2, 0.0, 0.0}, {});
  EXPECT_EQ(drive.at({1.9, 0.0, 0.0}, {kFreeEdge}), Refusals{""});
  EXPECT_EQ(drive.at({2.7, 0.0, 0.0}, {kFreeEdge}), Refusals{""});
  EXPECT_EQ(drive.at({3.2, 0.0, 0.0}, {kFreeEdge}), Refusals{""});
}

TEST(DoorLeaves, APieceOfWallWithoutADoorwayStays) {
  Scene scene;
  scene.faces.push_back({{3.2, 0.45}, {4.1, 0.45}, 60.0});
  scene.faces.push_back({{6.5, -4.0}, {6.5, 4.0}, 120.0});
  Drive drive(scene);
  drive.at({0.5, 0.0, 0.0}, {});
  drive.at({1.2, 0.0, 0.0}, {});
  EXPECT_EQ(drive.at({1.9, 0.0, 0.0}, {kFreeEdge}), Refusals{""});
}

}  // namespace
}  // namespace colonnade::testing
