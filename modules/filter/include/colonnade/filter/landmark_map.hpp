// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "colonnade/base/landmark.hpp"
#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// One landmark as users and exporters see it, whatever parameters the filter keeps.
struct LandmarkRecord {
  LandmarkId id{};
  LandmarkKind kind = LandmarkKind::kPillarEdge;
  /// Vertical landmarks: where they stand. Floor edges: the middle of the extent. World, metres.
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance =
      Eigen::Matrix2d::Zero();  ///< of p_world; floor edges: across the line only
  /// Floor edges: direction of the line in the world, in [0, pi), and its standard deviation.
  std::optional<double> direction;
  double direction_sigma = 0.0;
  Eigen::Vector2d extent_a = Eigen::Vector2d::Zero();  ///< ends of the seen part; points: p_world
  Eigen::Vector2d extent_b = Eigen::Vector2d::Zero();
  int hallway = -1;                   ///< number of the hallway, -1 = none
  std::optional<LandmarkId> pair_id;  ///< the other edge of the same pillar
  int observations = 0;
  double first_stamp_s = 0.0;
  double last_stamp_s = 0.0;
};

using LandmarkMap = std::vector<LandmarkRecord>;  ///< ordered by id

/// The same map in another world.
LandmarkMap moved(LandmarkMap map, const Pose2& T_new_old);

}  // namespace colonnade
