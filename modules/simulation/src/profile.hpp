// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

/// A straight piece of a wall's outline in plan, free space on its left.
struct ProfilePiece {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  double height_m = 0.0;
  std::size_t material = 0;
  bool skirting = false;
  bool gap = false;  ///< nothing stands here: the middle of an opening
};

/// The outline of a wall in plan with everything that stands out of it or is let into it, in the
/// direction of the wall. `symmetric` groups: piece boundaries i and j of one feature mirror each
/// other, which is how the two edges of a door or pilaster find each other.
struct Profile {
  std::vector<ProfilePiece> pieces;
  /// (i, j): the start of pieces[i] and the start of pieces[j] are partners.
  std::vector<std::pair<std::size_t, std::size_t>> partners;
};

/// Throws Error (kUsage) when doors and pilasters overlap.
Profile wallProfile(const World& world, std::size_t wall);

}  // namespace colonnade
