// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/random_world.hpp"

namespace colonnade {

/// A straight part of a corridor, or a hall.
struct Leg {
  Eigen::Vector2d from;  ///< on its centre line, where it meets its neighbours
  Eigen::Vector2d to;
  double half_m = 1.0;  ///< half its width
  bool hall = false;

  double length() const { return (to - from).norm(); }
  Eigen::Vector2d along() const { return (to - from).normalized(); }
  Eigen::Vector2d left() const { return {-along().y(), along().x()}; }
};

/// A wall of the corridor: free space on the left of a to b.
struct PlanWall {
  std::string name;
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  int leg = -1;  ///< -1: across its end

  double length() const { return (b - a).norm(); }
  Eigen::Vector2d along() const { return (b - a).normalized(); }
  Eigen::Vector2d out() const { return {-along().y(), along().x()}; }
  Eigen::Vector2d at(double s, double t) const { return a + s * along() + t * out(); }
};

/// Axis-parallel, grown a little: floor that is taken.
struct Area {
  Eigen::Vector2d low;
  Eigen::Vector2d high;

  static Area around(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin_m) {
    return {a.cwiseMin(b).array() - margin_m, a.cwiseMax(b).array() + margin_m};
  }
  bool overlaps(const Area& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
};

/// The corridors of a random building. The first leg runs along x through the origin; all
/// coordinates are whole centimetres.
struct RandomPlan {
  std::vector<Leg> legs;
  bool ring = false;  ///< the last leg meets the first
  std::vector<PlanWall> walls;
  std::vector<Area> taken;
};

RandomPlan drawPlan(Random& random, const RandomWorldOptions& options);

/// Uniform between two values, in whole centimetres.
double between(Random& random, double low, double high);

}  // namespace colonnade
