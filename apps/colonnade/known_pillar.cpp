// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "known_pillar.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace colonnade {
namespace {

struct Pair {
  double left_px, right_px;
  double width_m;  ///< 0: not known
  PillarPlace place;
};

/// The column of an edge in one row.
double columnAt(const Detection& edge, double row_px) {
  const Eigen::Vector2d along = edge.b_px - edge.a_px;
  return edge.a_px.x() + along.x() * (row_px - edge.a_px.y()) / along.y();
}

std::vector<Pair> pairsOf(const Frame& frame, const Detections& detections) {
  const Eigen::Vector3d axis = frame.T_robot_camera.linear().col(2);
  const double camera_yaw = std::atan2(axis.y(), axis.x());
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const Detection* left = &detections[i];
    if (!left->accepted() || left->kind() != LandmarkKind::kPillarEdge || !left->partner ||
        *left->partner <= i || *left->partner >= detections.size())
      continue;
    const Detection* right = &detections[*left->partner];
    const double top = std::max(left->a_px.y(), right->a_px.y());
    const double bottom = std::min(left->b_px.y(), right->b_px.y());
    if (!(top < bottom)) continue;
    const double row = std::clamp(frame.camera.cy_px, top, bottom);
    if (columnAt(*left, row) > columnAt(*right, row)) std::swap(left, right);
    Pair pair{columnAt(*left, row), columnAt(*right, row), left->width_m, {}};
    pair.place.left_rho_px = pair.left_px;
    pair.place.delta_rho_px = pair.right_px - pair.left_px;
    if (left->measurement.hasRange() && right->measurement.hasRange()) {
      const auto& l = left->measurement.z;
      const auto& r = right->measurement.z;
      pair.place.distance =
          0.5 * (l[1] * std::cos(l[0] - camera_yaw) + r[1] * std::cos(r[0] - camera_yaw));
      pair.place.lateral = l[1] * std::sin(l[0] - camera_yaw);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

std::optional<PillarPlace> KnownPillar::find(const Frame& frame, const Detections& detections) {
  constexpr double kForget_s = 1.0;
  if (last_ && frame.stamp_s - last_->stamp_s > kForget_s) last_.reset();
  const Pair* best = nullptr;
  double least = 0.0;
  const std::vector<Pair> pairs = pairsOf(frame, detections);
  for (const Pair& pair : pairs) {
    double cost = 0.0;
    if (last_) {
      cost = std::max(std::abs(pair.left_px - last_->left_px),
                      std::abs(pair.right_px - last_->right_px));
      if (cost > 0.08 * frame.camera.width_px) continue;
    } else if (width_m_ > 0.0 && pair.width_m > 0.0) {
      cost = std::abs(pair.width_m - width_m_) / width_m_;
      if (cost > 0.25) continue;
    } else {
      cost = 1e6 - *pair.place.delta_rho_px;  // any pair whose width depth confirms comes first
    }
    if (best && cost >= least) continue;
    best = &pair;
    least = cost;
  }
  if (!best) return std::nullopt;
  last_ = {best->left_px, best->right_px, frame.stamp_s};
  return best->place;
}

}  // namespace colonnade
