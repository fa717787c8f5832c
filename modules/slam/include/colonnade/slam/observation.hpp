// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/wall_direction_detector.hpp"
#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// How far one sees in one frame, direction by direction. Empty without depth: then nobody can
/// tell hidden from gone.
struct Sight {
  struct Ray {
    double bearing = 0.0;  ///< in the robot's axes, counter-clockwise
    double range_m = 0.0;  ///< horizontally from the camera to the first surface; 0 = not measured
  };
  std::vector<Ray> rays;  ///< bearings ascending
  Eigen::Vector2d p_robot_camera = Eigen::Vector2d::Zero();
};

/// The sight a depth slice allows.
Sight sightOf(const DepthProfile& profile);

/// All that mapping needs of one frame: no image is left.
struct Observation {
  std::size_t index = 0;
  double stamp_s = 0.0;
  MotionIncrement motion;
  Detections detections;
  std::vector<WallDirection> walls;  ///< longest first
  Sight sight;
  std::vector<std::string> lacking = {};  ///< why the frame shows nothing, to be counted
};

}  // namespace colonnade
