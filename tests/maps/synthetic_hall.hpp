// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/frames/frame.hpp"
#include "temporary_folder.hpp"

namespace colonnade::testing {

/// A vertical wall on the floor z = 0, as high as one likes.
struct Wall {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};
using Walls = std::vector<Wall>;

Walls rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
/// A corridor 12 m long and 2 m wide along x with pillars at its sides, unequally spaced.
Walls corridor();

/// Horizontal distance from `from` along `direction` (unit length) to the nearest wall; 1e9 if
/// none.
double distanceTo(const Walls& walls, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& direction);

/// A camera `height_m` above the floor and `forward_m` ahead of the robot's centre, pitched down.
Eigen::Isometry3d mountCamera(double forward_m, double height_m, double pitch_down,
                              double roll = 0.0, double yaw = 0.0);

/// The exact depth image of walls and floor, 320x240, about 60 degrees wide.
Frame renderFrame(const Walls& walls, const Pose2& T_world_robot,
                  const Eigen::Isometry3d& T_robot_camera, double stamp_s);

LandmarkMap someLandmarks();

std::string contentOf(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace colonnade::testing
