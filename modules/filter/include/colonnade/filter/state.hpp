// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/base/landmark.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/filter/measurement_models.hpp"

namespace colonnade {

/// What has been seen of a landmark, beside its place in the state.
struct Evidence {
  int observations = 0;
  /// One of several places a landmark may have: nothing matches it and no map shows it.
  bool hypothesis = false;
  double first_stamp_s = 0.0;
  double last_stamp_s = 0.0;
  /// Floor edges: the seen part, metres along the line from the foot of the anchor, in the
  /// direction of the normal turned by +90 degrees.
  double along_min_m = 0.0;
  double along_max_m = 0.0;
};

/// Where a block of parameters lies in the state vector.
struct Block {
  LandmarkId id{};  ///< identity of a landmark, axis or clone; one sequence for all
  BlockKind block_kind = BlockKind::kPoint;
  LandmarkKind landmark_kind = LandmarkKind::kPillarEdge;  ///< landmarks only
  int offset = 0;
  Evidence evidence;

  int size() const { return sizeOf(block_kind); }
  bool isLandmark() const {
    return block_kind != BlockKind::kAxis && block_kind != BlockKind::kPoseClone;
  }
};

/// The robot's pose (x, y, phi) first, then the blocks in the order of their birth. Data only:
/// covariance.hpp holds the functions that change x and P.
struct State {
  Eigen::VectorXd x = Eigen::Vector3d::Zero();
  Eigen::MatrixXd P = Eigen::Matrix3d::Zero();  ///< symmetric, both triangles kept
  std::vector<Block> blocks;

  Pose2 T_world_robot() const { return {x(0), x(1), x(2)}; }
  BlockVector values(const Block& block) const { return x.segment(block.offset, block.size()); }
  /// nullptr when there is none of that identity.
  const Block* find(LandmarkId id) const;
  Block* find(LandmarkId id);
};

/// G(x): how the whole state moves under a turn of the world about its origin, per radian:
/// (-y, x) for every point, 1 for every direction, 0 for distances along a ray or a normal.
Eigen::VectorXd worldTurn(const State& state);

}  // namespace colonnade
