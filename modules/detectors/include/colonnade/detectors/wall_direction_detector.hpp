// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/detectors/depth_profile.hpp"
#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {

/// A straight piece of wall in the depth profile, in the robot's axes.
struct WallDirection {
  double direction = 0.0;  ///< modulo a quarter turn, in [-pi/4, pi/4]
  double sigma = 0.0;
  double length_m = 0.0;
  Eigen::Vector2d p_robot_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_robot_b = Eigen::Vector2d::Zero();
};

struct WallDirectionOptions {
  static constexpr const char* kSection = "WallDirections";
  double min_length_m = 0.5;
  double max_range_m = 5.0;
  double tolerance_m = 0.025;       ///< of a point from its wall, beyond noise
  double min_sigma = radians(0.4);  ///< error that no number of points averages out
  double max_sigma = radians(3.0);
  double jump_m = 0.15;  ///< between neighbours of different surfaces

  void visit(OptionVisitor& v) {
    v.number("min_length_m", min_length_m, {0.1, 10}, "shortest wall");
    v.number("max_range_m", max_range_m, {0.5, 20}, "farthest depth used");
    v.number("tolerance_m", tolerance_m, {0.001, 0.5}, "of a point from its wall, beyond noise");
    v.angle("min_sigma_deg", min_sigma, {0.01, 10}, "error of a direction however long the wall");
    v.angle("max_sigma_deg", max_sigma, {0.1, 45}, "walls known worse are left out");
    v.number("jump_m", jump_m, {0.02, 2}, "between neighbours of different surfaces");
  }
};

/// Directions of walls for building axes: the depth profile is cut at jumps, split where it bends
/// (iterative end point fit) and each piece fitted by total least squares.
class WallDirectionDetector {
 public:
  explicit WallDirectionDetector(const WallDirectionOptions& options = {},
                                 const DepthProfileOptions& profile = {})
      : options_(options), profile_(profile) {}

  std::vector<WallDirection> detect(const Frame& frame) const;
  std::vector<WallDirection> detect(const DepthProfile& profile) const;

 private:
  WallDirectionOptions options_;
  DepthProfileOptions profile_;
};

}  // namespace colonnade
