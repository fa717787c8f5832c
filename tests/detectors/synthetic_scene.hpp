// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/detectors/detector_bank.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade::testing {

/// An upright rectangle in the robot's axes: a wall, the face of a pillar, a skirting board.
struct Face {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  double gray = 120.0;
  double bottom_m = 0.0;
  double top_m = 2.5;
  double lean = 0.0;  ///< x of the upper edge moves away by so much per metre of height
};

/// A painted strip on the floor between two points.
struct Strip {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  double width_m = 0.1;
  double gray = 40.0;
};

struct Scene {
  std::vector<Face> faces;
  std::vector<Strip> strips;
  double floor_gray = 180.0;
};

struct CameraPlace {
  double height_m = 1.2;
  double pitch_down = 0.0;
  double roll = 0.0;
  double yaw = 0.0;
  Eigen::Vector2d p_robot = Eigen::Vector2d::Zero();
};

Eigen::Isometry3d mounting(const CameraPlace& place);

/// Casts a ray through nine places of each pixel (gray) and through its middle (depth).
Frame render(const Scene& scene, const CameraPlace& place, int width_px = 640, int height_px = 480);

/// Adds pixel noise to gray and Kinect noise (Nguyen et al. 2012) to depth, the latter shared by
/// blocks of 3x3 pixels.
Frame withNoise(const Frame& frame, double gray_sigma, std::uint32_t seed);

/// The whole image stage and all detectors.
Detections detectAll(const Frame& frame, const DetectorOptions& options = {});

/// Accepted detections of a kind.
Detections accepted(const Detections& detections, LandmarkKind kind);

/// The accepted one whose bearing is nearest, or null.
const Detection* nearestBearing(const Detections& detections, double bearing);

inline double bearingOf(const Eigen::Vector2d& p) { return std::atan2(p.y(), p.x()); }

}  // namespace colonnade::testing
