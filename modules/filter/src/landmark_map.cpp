// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/landmark_map.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {
namespace {

/// Of a line, in [0, pi).
double undirected(double direction) {
  const double wrapped = wrapAngle(direction);
  return wrapped < 0.0 ? wrapped + kPi : (wrapped >= kPi ? 0.0 : wrapped);
}

/// An inverse depth that may as well be zero is a direction yet, no place.
bool isSettledEnough(const State& state, const Block& block) {
  if (block.block_kind != BlockKind::kInverseDepth) return true;
  const double sigma = std::sqrt(std::max(0.0, state.P(block.offset + 3, block.offset + 3)));
  return state.x(block.offset + 3) > 2.0 * sigma && state.x(block.offset + 3) > 1e-3;
}

void fillPoint(const State& state, const Block& block, LandmarkRecord& record) {
  const auto P = state.P.block(block.offset, block.offset, block.size(), block.size());
  if (block.block_kind == BlockKind::kPoint) {
    record.p_world = state.values(block);
    record.covariance = P;
  } else {
    Eigen::Matrix<double, 2, 4> J;
    record.p_world = pointOf(state.values(block), &J);
    record.covariance = J * P * J.transpose();
  }
  record.extent_a = record.extent_b = record.p_world;
}

/// The line m . (p - anchor) = d at `along` metres from the anchor's foot, and the variance of that
/// point across the line: d(m . (p - anchor) - d) by anchor, alpha and d.
void fillLine(const State& state, const Block& block, LandmarkRecord& record) {
  const BlockVector y = state.values(block);
  const Eigen::Vector2d m(std::cos(y(2)), std::sin(y(2)));
  const Eigen::Vector2d along(-m.y(), m.x());
  const Eigen::Vector2d foot = y.head<2>() + y(3) * m;
  const auto at = [&](double s) -> Eigen::Vector2d { return foot + s * along; };
  const double middle = 0.5 * (block.evidence.along_min_m + block.evidence.along_max_m);
  record.extent_a = at(block.evidence.along_min_m);
  record.extent_b = at(block.evidence.along_max_m);
  record.p_world = at(middle);
  record.direction = undirected(y(2) + kPi / 2.0);
  record.direction_sigma = std::sqrt(std::max(0.0, state.P(block.offset + 2, block.offset + 2)));
  Eigen::RowVector4d J;
  J << m.transpose(), -middle, 1.0;
  const double variance =
      (J * state.P.block<4, 4>(block.offset, block.offset) * J.transpose()).value();
  record.covariance = std::max(0.0, variance) * m * m.transpose();
}

}  // namespace

LandmarkMap moved(LandmarkMap map, const Pose2& T_new_old) {
  const Eigen::Matrix2d R = T_new_old.rotation();
  for (LandmarkRecord& landmark : map) {
    landmark.p_world = transform(T_new_old, landmark.p_world);
    landmark.extent_a = transform(T_new_old, landmark.extent_a);
    landmark.extent_b = transform(T_new_old, landmark.extent_b);
    landmark.covariance = (R * landmark.covariance * R.transpose()).eval();
    if (landmark.direction) landmark.direction = undirected(*landmark.direction + T_new_old.phi);
  }
  return map;
}

std::optional<Eigen::Vector2d> EkfSlam::placeOf(LandmarkId landmark) const {
  if (const Block* resting = resting_.find(landmark)) return resting_.valueThen(*resting).head<2>();
  const Block* block = state_.find(landmark);
  if (!block || !block->isLandmark() || block->evidence.hypothesis ||
      !isSettledEnough(state_, *block))
    return std::nullopt;
  const BlockVector y = state_.values(*block);
  return block->block_kind == BlockKind::kInverseDepth ? pointOf(y) : y.head<2>();
}

LandmarkMap EkfSlam::landmarkMap() const {
  if (!resting_.empty()) return EkfSlam(options_, fullState()).landmarkMap();
  LandmarkMap map;
  for (const Block& block : state_.blocks) {
    if (!block.isLandmark() || block.evidence.hypothesis || !isSettledEnough(state_, block))
      continue;
    LandmarkRecord record;
    record.id = block.id;
    record.kind = block.landmark_kind;
    record.observations = block.evidence.observations;
    record.first_stamp_s = block.evidence.first_stamp_s;
    record.last_stamp_s = block.evidence.last_stamp_s;
    if (block.block_kind == BlockKind::kFloorLine)
      fillLine(state_, block, record);
    else
      fillPoint(state_, block, record);
    map.push_back(record);
  }
  return map;
}

}  // namespace colonnade
