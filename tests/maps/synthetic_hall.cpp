// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "synthetic_hall.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace colonnade::testing {

Walls rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const Eigen::Vector2d right_low(high.x(), low.y());
  const Eigen::Vector2d left_high(low.x(), high.y());
  return {{low, right_low}, {right_low, high}, {high, left_high}, {left_high, low}};
}

Walls corridor() {
  Walls walls = rectangle({-1.0, -1.0}, {11.0, 1.0});
  const double pillars[][2] = {{1.5, 0.85}, {2.4, -0.85}, {4.6, 0.85}, {5.1, -0.85}, {8.2, 0.85}};
  for (const auto& [x, y] : pillars)
    for (const auto& wall : rectangle({x - 0.15, y - 0.15}, {x + 0.15, y + 0.15}))
      walls.push_back(wall);
  return walls;
}

double distanceTo(const Walls& walls, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& direction) {
  double nearest = 1e9;
  for (const auto& wall : walls) {
    const Eigen::Vector2d along = wall.b - wall.a;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const Eigen::Vector2d offset = wall.a - from;
    const double distance = (offset.x() * along.y() - offset.y() * along.x()) / cross;
    const double share = (offset.x() * direction.y() - offset.y() * direction.x()) / cross;
    if (distance > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

Eigen::Isometry3d mountCamera(double forward_m, double height_m, double pitch_down, double roll,
                              double yaw) {
  Eigen::Matrix3d R_level_camera;  // columns: where the camera's right, down and forward point
  R_level_camera.col(0) = -Eigen::Vector3d::UnitY();
  R_level_camera.col(1) = -Eigen::Vector3d::UnitZ();
  R_level_camera.col(2) = Eigen::Vector3d::UnitX();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(pitch_down, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) * R_level_camera;
  T_robot_camera.translation() << forward_m, 0.0, height_m;
  return T_robot_camera;
}

Frame renderFrame(const Walls& walls, const Pose2& T_world_robot,
                  const Eigen::Isometry3d& T_robot_camera, double stamp_s) {
  Frame frame;
  frame.stamp_s = stamp_s;
  frame.camera = {320, 240, 270.0, 270.0, 159.5, 119.5};
  frame.T_robot_camera = T_robot_camera;
  frame.depth_m.create(240, 320, CV_32FC1);
  const Eigen::Isometry3d T_world_camera = T_world_robot.toIsometry3() * T_robot_camera;
  const Eigen::Vector2d from = T_world_camera.translation().head<2>();
  const double height = T_world_camera.translation().z();
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      // The ray's length unit is one metre of depth.
      const Eigen::Vector3d ray = T_world_camera.linear() * frame.camera.ray(u, v);
      const double horizontal = ray.head<2>().norm();
      double depth = distanceTo(walls, from, ray.head<2>() / horizontal) / horizontal;
      if (ray.z() < 0.0) depth = std::min(depth, -height / ray.z());
      frame.depth_m.at<float>(v, u) = depth < 20.0 ? static_cast<float>(depth) : 0.0F;
    }
  return frame;
}

LandmarkMap someLandmarks() {
  LandmarkRecord left;
  left.id = LandmarkId{3};
  left.p_world = left.extent_a = left.extent_b = {1.5, 0.7};
  left.covariance << 0.01, 0.002, 0.002, 0.03;
  left.hallway = 0;
  left.pair_id = LandmarkId{4};
  left.observations = 17;
  left.first_stamp_s = 1700000000.25;
  left.last_stamp_s = 1700000009.5;
  LandmarkRecord right = left;
  right.id = LandmarkId{4};
  right.p_world = right.extent_a = right.extent_b = {1.8, 0.7};
  right.pair_id = LandmarkId{3};
  LandmarkRecord wall;
  wall.id = LandmarkId{10};
  wall.kind = LandmarkKind::kFloorEdge;
  wall.extent_a = {-1.0, 1.0};
  wall.extent_b = {11.0, 1.5};
  wall.p_world = 0.5 * (wall.extent_a + wall.extent_b);
  wall.direction = std::atan2(0.5, 12.0);
  wall.direction_sigma = 0.01;
  wall.covariance << 0.0001, -0.0002, -0.0002, 0.004;
  wall.observations = 120;
  wall.last_stamp_s = 1700000011.0;
  LandmarkRecord corner;
  corner.id = LandmarkId{12};
  corner.kind = LandmarkKind::kDepthSlope;
  corner.p_world = corner.extent_a = corner.extent_b = {11.0, -1.0};
  corner.covariance << 0.05, 0.0, 0.0, 0.02;
  corner.hallway = 2;
  corner.observations = 5;
  return {left, right, wall, corner};
}

std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace colonnade::testing
