// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
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
  LandmarkId id{};  ///< identity of a landmark, axis, clone or sensor; one sequence for all
  BlockKind block_kind = BlockKind::kPoint;
  LandmarkKind landmark_kind = LandmarkKind::kPillarEdge;  ///< landmarks only
  int offset = 0;
  Evidence evidence;

  int size() const { return sizeOf(block_kind); }
  bool isLandmark() const {
    return block_kind == BlockKind::kPoint || block_kind == BlockKind::kInverseDepth ||
           block_kind == BlockKind::kFloorLine;
  }
};

/// What the state went through since a part of the map was put to rest, so that the resting part
/// can follow later in one step: the compressed filter of Guivant and Nebot (IEEE Transactions on
/// Robotics and Automation 17(3), 2001). C is the covariance of the resting part (rows) with the
/// state (k columns) at that time, n the size of the state now.
struct Transfer {
  Eigen::MatrixXd Phi;  ///< n x k: the state's covariance with the resting part is Phi C^T
  Eigen::MatrixXd Psi;  ///< k x k: the resting part's own covariance lost C Psi C^T
  /// k x 3: the resting values moved by C times the first column, those of points, whose
  /// displacement is spread over the turn of a correction, by C times the second and, turned by a
  /// right angle, the third.
  Eigen::MatrixX3d theta;
};

/// The robot's pose (x, y, phi) first, then the blocks in the order of their birth. Data only:
/// covariance.hpp holds the functions that change x and P.
struct State {
  Eigen::VectorXd x = Eigen::Vector3d::Zero();
  Eigen::MatrixXd P = Eigen::Matrix3d::Zero();  ///< symmetric, both triangles kept
  std::vector<Block> blocks;
  std::optional<LandmarkId> sensor;  ///< its block (kSensor), where its errors are estimated
  std::optional<Transfer> transfer;  ///< only while a part of the map rests

  Pose2 T_world_robot() const { return {x(0), x(1), x(2)}; }
  BlockVector values(const Block& block) const { return x.segment(block.offset, block.size()); }
  /// nullptr when there is none of that identity.
  const Block* find(LandmarkId id) const;
  Block* find(LandmarkId id);
};

/// G(x): how the whole state moves under a turn of the world about its origin, per radian:
/// (-y, x) for every point, 1 for every direction, 0 for all else.
Eigen::VectorXd worldTurn(const State& state);

}  // namespace colonnade
