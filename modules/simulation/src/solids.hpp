// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// An upright prism: a pillar, the leaf of an open door, a part of a table.
struct Solid {
  std::string name;
  std::vector<Eigen::Vector2d> outline;  ///< clockwise: its outside is on the left
  double bottom_m = 0.0;
  double top_m = 0.0;
  std::size_t material = 0;
  bool round = false;  ///< the outline stands for a circle: its corners are no edges
  Belonging belonging = Belonging::kBuilding;

  bool standing() const { return bottom_m == 0.0; }
};

/// Everything that stands free in a world.
std::vector<Solid> solidsOf(const World& world);

}  // namespace colonnade
