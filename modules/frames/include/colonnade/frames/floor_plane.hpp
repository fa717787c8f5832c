// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "colonnade/base/angle.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The floor as one depth image shows it, in the optical frame (x right, y down, z forward): points
/// of the floor satisfy normal . p + height_m = 0.
struct FloorPlane {
  Eigen::Vector3d normal_camera = -Eigen::Vector3d::UnitY();  ///< unit, points up
  double height_m = 0.0;  ///< of the optical centre above the floor
  int inliers = 0;        ///< of the subsampled points
  double rms_m = 0.0;     ///< of their distances from the plane
};

/// What is known about the floor before.
struct FloorPrior {
  Eigen::Vector3d up_camera = -Eigen::Vector3d::UnitY();  ///< expected direction of the normal
  double tolerance = radians(45.0);                       ///< of the normal around it
  std::optional<double> height_m;                         ///< expected height of the camera
  double height_tolerance_m = 0.3;
  double nearest_m = 0.3;  ///< depth outside of [nearest, farthest] is not used
  double farthest_m = 6.0;
  int least_inliers = 150;  ///< of about 4800 points
};

/// Finds the lowest large plane that is roughly horizontal, or nothing. Points of a coarse grid
/// whose local surface faces up vote by RANSAC (a fixed seed: same image, same answer); planes with
/// measured points below them lose; the winner is refined by least squares. A further plane below
/// the winner takes its place (the floor beside a table).
/// `depth_m`: CV_32FC1, metres, 0 = not measured. About 1 ms for 640x480.
std::optional<FloorPlane> fitFloorPlane(const cv::Mat& depth_m, const PinholeCamera& camera,
                                        const FloorPrior& prior = {});

/// The pose of the optical frame on a robot whose origin lies on the floor below the camera and
/// whose x axis is the optical axis projected onto the floor.
Eigen::Isometry3d cameraAboveFloor(const Eigen::Vector3d& normal_camera, double height_m);

}  // namespace colonnade
