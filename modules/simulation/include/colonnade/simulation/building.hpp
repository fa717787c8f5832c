// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

/// What a thing is to a map: part of the building, or something that may be elsewhere tomorrow.
enum class Belonging {
  kBuilding,   ///< walls, pilasters, pillars, door frames, closed doors
  kRound,      ///< round pillars
  kFixture,    ///< hangs on a wall or in an opening: boards, lintels, rims of glass leaves
  kLeaf,       ///< of an open door
  kCabinet,    ///< stands as long as nobody moves it
  kFurniture,  ///< tables, chairs, bins
};

/// A painted rectangle: origin + s along + t up, s and t in [0, 1]. Its front is the side from
/// which `along` points right and `up` up. Metres, world.
struct Face {
  Eigen::Vector3d origin;
  Eigen::Vector3d along;
  Eigen::Vector3d up;
  std::size_t material = 0;
  double skirting_m = 0.0;  ///< height of the painted strip at its foot
  std::size_t skirting_material = 0;
  bool glows = false;  ///< a lamp: not lit by others
  Surface surface = Surface::kOpaque;
  Belonging belonging = Belonging::kBuilding;

  Eigen::Vector3d normal() const { return along.cross(up).normalized(); }
};

/// A vertical edge of the building that stands on the floor.
struct VerticalEdge {
  Eigen::Vector2d p_world;
  double height_m = 0.0;
  bool convex = false;
  /// Both faces that meet here are wide enough to turn the depth profile.
  bool slope = false;
  std::optional<std::size_t> partner;  ///< the other edge of the same pillar or door
  int hallway = -1;
  Belonging belonging = Belonging::kBuilding;
};

/// A line in which a wall meets the floor.
struct FloorLine {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  int hallway = -1;
  double height_m = 0.0;  ///< of what stands there
};

/// What a robot can run into, in plan.
struct Obstacle {
  std::string name;  ///< such as "wall south"
  std::vector<Eigen::Vector2d> outline;
  bool solid = false;     ///< the outline is closed: the last point meets the first
  double bottom_m = 0.0;  ///< above 0: a table top
};

/// What a world looks like: everything that is drawn, and everything that can be a landmark.
struct Building {
  std::vector<Face> faces;
  std::vector<VerticalEdge> edges;
  std::vector<FloorLine> floor_lines;
  std::vector<FloorLine> outline;  ///< as floor_lines, with the narrow pieces
  std::vector<FloorLine> gaps;     ///< openings one can drive through
  std::vector<Obstacle> obstacles;
  Eigen::Vector2d low;  ///< bounding box on the floor
  Eigen::Vector2d high;
  double ceiling_m = 0.0;
};

/// Faces narrower than this make no slope corner and no floor line.
inline constexpr double kNarrowFaceM = 0.08;

/// Throws Error when doors and pilasters of a wall overlap.
Building buildBuilding(const World& world);

}  // namespace colonnade
