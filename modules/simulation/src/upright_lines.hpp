// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// A line that is vertical in space and drawn, but no row of the landmarks.
struct UprightLine {
  /// What it is, as the columns file says it:
  ///   minor      stands on the floor and belongs to the building, but is not listed: an edge
  ///              within 6 cm of a listed one, the rim of a glass door, a joint over a wall's
  ///              height
  ///   fixture    hangs on a wall or ends above the floor: boards, lintels
  ///   mark       painted and shorter: lines around the panels of a door
  ///   leaf, cabinet, furniture   of an open door, a cabinet; a table, chair or bin
  std::string kind;
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  double bottom_m = 0.0;
  double top_m = 0.0;
};

/// How the columns file calls an edge of what belongs to so and so.
const char* kindOf(Belonging belonging);

/// Sides of upright faces and the upright lines painted on them, without seams in one plane and
/// paint, without the facets of round pillars, without what `building.edges` lists.
std::vector<UprightLine> uprightLinesOf(const World& world, const Building& building);

/// The outlines of round pillars, clockwise in plan, as they are drawn.
struct RoundOutline {
  std::vector<Eigen::Vector2d> corners;
  double top_m = 0.0;
};
std::vector<RoundOutline> roundOutlinesOf(const World& world);

/// One end of what a viewer sees of an outline, and a corner two further on towards the viewer,
/// where the surface is seen less aslant: whether it is hidden can be told there.
struct OutlineEnd {
  Eigen::Vector2d p_world;
  Eigen::Vector2d p_inner;
};

/// Both ends; nothing from within.
std::vector<OutlineEnd> silhouette(const RoundOutline& outline, const Eigen::Vector2d& p_eye);

}  // namespace colonnade
