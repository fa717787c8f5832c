// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// An occupancy grid as a picture, north (y) up: CV_8UC1, 0 = occupied, 254 = free, 205 = unknown,
/// as ROS map servers have it. Empty when there is no grid.
struct GridPicture {
  cv::Mat cells;
  double resolution_m = 0.05;
  Eigen::Vector2d p_world_corner = Eigen::Vector2d::Zero();  ///< outer corner, least x and y
};

/// What a picture of the map shows. Everything may be empty.
struct MapPicture {
  std::string title;
  LandmarkMap landmarks;
  Trajectory trajectory;
  Trajectory ground_truth;  ///< already in the map's world
  GridPicture grid;
  bool number_landmarks = false;
  int width_px = 1200;
};

/// The map from above, for people: grid, path, landmarks by kind with their 95 % ellipses, truth,
/// scale bar and legend. CV_8UC3.
cv::Mat drawMap(const MapPicture& picture);

/// Draws it into a PNG file, atomically.
void writeMapPicture(const std::filesystem::path& path, const MapPicture& picture);

}  // namespace colonnade
