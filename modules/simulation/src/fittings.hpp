// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

inline Eigen::Vector3d atHeight(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

/// An upright face over the line from a to b, seen from the left of that line.
Face uprightFace(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double bottom, double top,
                 std::size_t material);

/// A material every world has.
std::size_t materialNamed(const World& world, const char* name);

/// What hangs on a wall and is not seen in plan: the wall above a door, the head of its frame, the
/// soffit of the opening and the rim of a glass leaf.
std::vector<Face> doorHead(const World& world, const Door& door);

std::vector<Face> boardFaces(const World& world, const Board& board);

/// The skirting board of a wall that stands out of it.
class SkirtingBoard {
 public:
  SkirtingBoard(const World& world, std::size_t wall);

  /// The line of its front along the piece of the wall from a to b: shorter in a concave corner
  /// of walls, longer around a convex one.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> frontOf(const Eigen::Vector2d& a,
                                                      const Eigen::Vector2d& b) const;
  std::vector<Face> faces(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

 private:
  const Wall& wall_;
  Eigen::Vector2d along_;
  Eigen::Vector2d out_;
  double at_start_m_ = 0.0;  ///< by how much the front begins after the wall
  double at_end_m_ = 0.0;    ///< and ends before it
};

}  // namespace colonnade
