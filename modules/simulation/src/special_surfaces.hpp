// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/seen_column.hpp"

namespace colonnade {

/// What of glass, mirrors and people a frame shows.
struct SpecialView {
  std::vector<SeenColumn> seen;  ///< one entry each: the box around its visible pixels
  cv::Mat no_return;             ///< CV_8UC1, 255 on glass and mirrors; empty where there are none
};

/// Finds glass, mirrors and people in the depth of a rendered view by their geometry.
class SpecialSurfaces {
 public:
  SpecialSurfaces(const World& world, const Building& building);

  /// depth_m: CV_32FC1, perfect.
  SpecialView look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                   double time_s) const;

 private:
  void lookAtFace(const Face& face, const cv::Mat& depth_m, const Eigen::Isometry3d& T_camera_world,
                  SpecialView& view) const;
  void lookAtWalker(std::size_t index, const cv::Mat& depth_m,
                    const Eigen::Isometry3d& T_world_camera, double time_s,
                    SpecialView& view) const;

  PinholeCamera camera_;
  std::vector<Face> faces_;  ///< of glass and mirrors
  std::vector<Walker> walkers_;
};

}  // namespace colonnade
