// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solids.hpp"

#include <cmath>

namespace colonnade {
namespace {

constexpr int kRoundSides = 24;
constexpr double kLeafM = 0.04;  ///< thickness of a door leaf
constexpr double kSlabM = 0.03;  ///< of a table top and a seat
constexpr double kTableLegM = 0.05;
constexpr double kChairLegM = 0.035;
constexpr double kSeatM = 0.45;  ///< height of a seat

/// A place in plan: x ahead, y to the left.
struct Place {
  Eigen::Vector2d centre;
  double turn;

  Eigen::Vector2d at(double x, double y) const {
    return centre + Eigen::Vector2d(x * std::cos(turn) - y * std::sin(turn),
                                    x * std::sin(turn) + y * std::cos(turn));
  }
};

/// Clockwise, its sides parallel to the place's axes.
std::vector<Eigen::Vector2d> rectangle(const Place& place, const Eigen::Vector2d& middle,
                                       const Eigen::Vector2d& size) {
  const double x0 = middle.x() - 0.5 * size.x(), x1 = middle.x() + 0.5 * size.x();
  const double y0 = middle.y() - 0.5 * size.y(), y1 = middle.y() + 0.5 * size.y();
  return {place.at(x0, y0), place.at(x0, y1), place.at(x1, y1), place.at(x1, y0)};
}

Solid solidOf(const Pillar& pillar) {
  Solid solid{
      "the pillar of " + pillar.where, {}, 0.0, pillar.height_m, pillar.material, pillar.round};
  const Place place{pillar.centre, pillar.turn};
  solid.belonging = pillar.round ? Belonging::kRound : Belonging::kBuilding;
  if (!pillar.round) {
    solid.outline = rectangle(place, {0, 0}, pillar.size);
    return solid;
  }
  for (int i = 0; i < kRoundSides; ++i) {
    const double angle = -2.0 * kPi * i / kRoundSides;
    const double radius = 0.5 * pillar.size.x();
    solid.outline.push_back(place.at(radius * std::cos(angle), radius * std::sin(angle)));
  }
  return solid;
}

Solid leafOf(const Door& door, const Wall& wall) {
  const Eigen::Vector2d along = (wall.b - wall.a) / wall.length();
  const Eigen::Vector2d out(-along.y(), along.x());
  // A wall runs to the left of who looks at its face.
  const double side = door.leaf->hinge_left ? 1.0 : -1.0;
  const Eigen::Vector2d hinge =
      wall.a + (door.at_m + side * 0.5 * door.width_m) * along - door.leaf->depth_m * out;
  const Eigen::Vector2d shut = -side * along;
  const double c = std::cos(door.leaf->angle), s = std::sin(door.leaf->angle);
  const Eigen::Vector2d leaf = c * shut - s * out;               // from the hinge
  const Eigen::Vector2d thick = kLeafM * (-s * shut - c * out);  // away from the opening
  const Eigen::Vector2d far = hinge + door.width_m * leaf;
  Solid solid{"the open door of " + door.where,
              {hinge, far, far + thick, hinge + thick},
              0.0,
              door.height_m,
              door.material,
              false};
  if (side > 0.0) solid.outline = {hinge, hinge + thick, far + thick, far};
  return solid;
}

/// Four legs in the corners of a rectangle.
void addLegs(std::vector<Solid>& solids, const Furniture& piece, const std::string& name,
             double leg_m, double top_m) {
  const Place place{piece.centre, piece.turn};
  const Eigen::Vector2d reach = 0.5 * piece.size - Eigen::Vector2d::Constant(0.5 * leg_m + 0.02);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      solids.push_back({name, rectangle(place, {x * reach.x(), y * reach.y()}, {leg_m, leg_m}), 0.0,
                        top_m, piece.leg_material, false});
    }
  }
}

void addFurniture(std::vector<Solid>& solids, const Furniture& piece) {
  const Place place{piece.centre, piece.turn};
  const auto whole = rectangle(place, {0, 0}, piece.size);
  switch (piece.kind) {
    case Furniture::Kind::kTable: {
      const std::string name = "the table of " + piece.where;
      const double under = piece.height_m - kSlabM;
      solids.push_back({name, whole, under, piece.height_m, piece.material, false});
      addLegs(solids, piece, name, kTableLegM, under);
      return;
    }
    case Furniture::Kind::kChair: {
      const std::string name = "the chair of " + piece.where;
      const double seat = std::min(kSeatM, 0.6 * piece.height_m);
      solids.push_back({name, whole, seat - kSlabM, seat, piece.material, false});
      const double back = 0.5 * (piece.size.x() - kSlabM);
      solids.push_back({name, rectangle(place, {-back, 0.0}, {kSlabM, piece.size.y()}), seat + 0.12,
                        piece.height_m, piece.material, false});
      addLegs(solids, piece, name, kChairLegM, seat - kSlabM);
      return;
    }
    case Furniture::Kind::kCabinet:
      solids.push_back(
          {"the cabinet of " + piece.where, whole, 0.0, piece.height_m, piece.material, false});
      return;
    case Furniture::Kind::kBin:
      solids.push_back(
          {"the bin of " + piece.where, whole, 0.0, piece.height_m, piece.material, false});
      return;
  }
}

}  // namespace

std::vector<Solid> solidsOf(const World& world) {
  std::vector<Solid> solids;
  for (const auto& pillar : world.pillars) solids.push_back(solidOf(pillar));
  for (const auto& door : world.doors) {
    if (!door.leaf) continue;
    solids.push_back(leafOf(door, world.walls[door.wall]));
    solids.back().belonging = Belonging::kLeaf;
  }
  for (const auto& piece : world.furniture) {
    const std::size_t first = solids.size();
    addFurniture(solids, piece);
    const bool cabinet = piece.kind == Furniture::Kind::kCabinet;
    for (std::size_t i = first; i < solids.size(); ++i)
      solids[i].belonging = cabinet ? Belonging::kCabinet : Belonging::kFurniture;
  }
  return solids;
}

}  // namespace colonnade
