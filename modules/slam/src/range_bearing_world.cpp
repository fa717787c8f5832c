// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_world.hpp"

namespace colonnade {
namespace {

constexpr int kFewestAnchors = 4;
constexpr double kLeastSpread_m = 1.0;
constexpr double kMostUnexplained = 0.3;  ///< of the mean square change

}  // namespace

std::optional<Pose2> motionOfMap(std::span<const PointPair> anchors) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double weights = 0.0;
  int count = 0;
  for (const PointPair& anchor : anchors) {
    middle += anchor.weight * anchor.p_a;
    weights += anchor.weight;
    count += anchor.weight > 0.0 ? 1 : 0;
  }
  if (count < kFewestAnchors) return std::nullopt;
  middle /= weights;
  const Pose2 back = rigidFit(anchors);
  double spread = 0.0, moved = 0.0, unexplained = 0.0;
  for (const auto& [p_before, p_now, weight] : anchors) {
    spread += weight * (p_before - middle).squaredNorm();
    moved += weight * (p_now - p_before).squaredNorm();
    unexplained += weight * (transform(back, p_now) - p_before).squaredNorm();
  }
  if (spread < kLeastSpread_m * kLeastSpread_m * weights) return std::nullopt;
  if (unexplained > kMostUnexplained * moved) return std::nullopt;
  return back;
}

}  // namespace colonnade
