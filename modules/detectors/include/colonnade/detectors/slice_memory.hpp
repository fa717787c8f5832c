// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/depth_profile.hpp"

namespace colonnade {

/// The depth slices of the way behind, carried along with the robot: which places of the plan were
/// seen to be free, and in which of them a surface was seen. Places are in the robot's axes.
class SliceMemory {
 public:
  /// max_way_m: of the robot, after which a slice is forgotten, since odometry drifts.
  explicit SliceMemory(double max_way_m) : max_way_m_(max_way_m) {}

  /// Takes in the slice of the present frame. Of the earlier ones those are kept from which the
  /// robot went or turned on a little.
  void add(const DepthProfile& profile);
  void move(const Pose2& T_previous_robot);
  void clear() { slices_.clear(); }

  /// Did a slice show something farther in that direction?
  bool isFree(const Eigen::Vector2d& p_robot) const;
  /// Did one show a surface there?
  bool isSurface(const Eigen::Vector2d& p_robot) const;

 private:
  struct Slice {
    std::vector<float> z_m;  ///< of its columns, 0 where not measured
    double focal_px = 0.0;
    Eigen::Matrix2d R_robot_slice;
    Eigen::Vector2d p_robot_camera;
    double way_m = 0.0;  ///< of the robot since then

    /// How much farther than that place the column is which looks there; nothing where none does.
    std::optional<double> beyond_m(const Eigen::Vector2d& p_robot) const;
  };

  double max_way_m_;
  std::vector<Slice> slices_;  ///< the latest last
};

}  // namespace colonnade
