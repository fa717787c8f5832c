// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_world.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kFewestAnchors = 4;
constexpr double kLeastSpread_m = 1.0;
constexpr double kMostUnexplained = 0.3;  ///< of the mean square change

}  // namespace

std::optional<Pose2> motionOfMap(const std::vector<WorldAnchor>& before,
                                 const std::vector<WorldAnchor>& after) {
  Eigen::Vector2d centre_before = Eigen::Vector2d::Zero(), centre_after = centre_before;
  double weights = 0.0;
  int anchors = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double weight = after[i].weight;
    centre_before += weight * before[i].p;
    centre_after += weight * after[i].p;
    weights += weight;
    anchors += weight > 0.0 ? 1 : 0;
  }
  if (anchors < kFewestAnchors) return std::nullopt;
  centre_before /= weights;
  centre_after /= weights;
  double sine = 0.0, cosine = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Eigen::Vector2d b = before[i].p - centre_before, a = after[i].p - centre_after;
    sine += after[i].weight * (a.x() * b.y() - a.y() * b.x());
    cosine += after[i].weight * a.dot(b);
    spread += after[i].weight * b.squaredNorm();
  }
  if (spread < kLeastSpread_m * kLeastSpread_m * weights) return std::nullopt;
  const Eigen::Rotation2Dd turn(std::atan2(sine, cosine));
  const Eigen::Vector2d shift = centre_before - turn * centre_after;
  double moved = 0.0, unexplained = 0.0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    moved += after[i].weight * (after[i].p - before[i].p).squaredNorm();
    unexplained += after[i].weight * (turn * after[i].p + shift - before[i].p).squaredNorm();
  }
  if (unexplained > kMostUnexplained * moved) return std::nullopt;
  return Pose2{shift.x(), shift.y(), turn.angle()};
}

}  // namespace colonnade
