// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/rigid_fit.hpp"

#include <cmath>

namespace colonnade {

Pose2 rigidFit(std::span<const PointPair> pairs) {
  Eigen::Vector2d middle_a = Eigen::Vector2d::Zero(), middle_b = middle_a;
  double weights = 0.0;
  for (const PointPair& pair : pairs) {
    middle_a += pair.weight * pair.p_a;
    middle_b += pair.weight * pair.p_b;
    weights += pair.weight;
  }
  middle_a /= weights;
  middle_b /= weights;
  double cosine = 0.0, sine = 0.0;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector2d a = pair.p_a - middle_a, b = pair.p_b - middle_b;
    cosine += pair.weight * b.dot(a);
    sine += pair.weight * (b.x() * a.y() - b.y() * a.x());
  }
  const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
  const Eigen::Vector2d t = middle_a - transform(turn, middle_b);
  return {t.x(), t.y(), turn.phi};
}

}  // namespace colonnade
