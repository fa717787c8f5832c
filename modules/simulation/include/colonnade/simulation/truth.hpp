// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// The landmarks a building really has, and how often a camera could have seen each.
///   pillar      every vertical edge that stands on the floor; pair_id: the mirrored edge of the
///               same pillar, pilaster or door
///   floor_edge  every line in which a wall, pillar or door leaf meets the floor, 0.08 m or longer
///   depth_slope the vertical edges between two faces that are both 0.08 m wide or wider
/// Covariances are zero. `observations` counts frames in which enough of the landmark is in the
/// picture, in front of everything else and within the range of the depth sensor.
class Truth {
 public:
  Truth(const World& world, const Building& building);

  /// Counts what is seen: perfect depth, CV_32FC1.
  void observe(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera, double stamp_s);

  const LandmarkMap& landmarks() const { return landmarks_; }

 private:
  struct Outline {
    Eigen::Vector3d a;
    Eigen::Vector3d b;
  };
  bool seen(const Outline& outline, const cv::Mat& depth_m,
            const Eigen::Isometry3d& T_camera_world) const;

  PinholeCamera camera_;
  double range_m_;
  LandmarkMap landmarks_;
  std::vector<Outline> outlines_;  ///< of landmarks_, in space
};

}  // namespace colonnade
