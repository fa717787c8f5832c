// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/seen_column.hpp"

namespace colonnade {

struct RoundOutline;
struct Surfaces;
struct UprightLine;

/// The landmarks a building really has, how often a camera could have seen each, and where.
///   pillar      every vertical edge that stands on the floor; pair_id: the mirrored edge of the
///               same pillar, pilaster or door
///   floor_edge  every line in which a wall, pillar or door leaf meets the floor, 0.08 m or longer
///   depth_slope the vertical edges between two faces that are both 0.08 m wide or wider
/// Covariances are zero. `observations` counts frames in which enough of the landmark is in the
/// picture, in front of everything else and within the range of the depth sensor.
class Truth {
 public:
  Truth(const World& world, const Building& building);
  ~Truth();

  /// Counts what is seen, and tells where: the landmarks, and other upright lines, of which
  /// kShortestPx or more are in the picture, at any distance. `gray`: CV_8UC1 without noise.
  std::vector<SeenColumn> observe(const Surfaces& surfaces, const cv::Mat& gray,
                                  const Eigen::Isometry3d& T_world_camera, double stamp_s);

  const LandmarkMap& landmarks() const { return landmarks_; }

  static constexpr double kShortestPx = 8.0;

 private:
  struct Outline {
    Eigen::Vector3d a;
    Eigen::Vector3d b;
  };

  PinholeCamera camera_;
  double range_m_;
  LandmarkMap landmarks_;
  std::vector<Outline> outlines_;   ///< of landmarks_, in space
  std::vector<std::string> kinds_;  ///< of landmarks_, as the columns file says it
  std::vector<UprightLine> others_;
  std::vector<RoundOutline> rounds_;
};

}  // namespace colonnade
