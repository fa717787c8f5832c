// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fittings.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kSamePlaceM = 1e-3;  ///< metres within which two wall ends meet
constexpr double kRimM = 0.09;        ///< width of the rim of a glass leaf
constexpr double kOffM = 0.004;       ///< by which one surface lies before another

/// A wall's own axes.
struct WallPlace {
  explicit WallPlace(const Wall& wall)
      : start(wall.a), along((wall.b - wall.a) / wall.length()), out(-along.y(), along.x()) {}

  Eigen::Vector2d at(double s, double t) const { return start + s * along + t * out; }

  Eigen::Vector2d start, along, out;
};

/// The turn of the path from one wall into the next, counter-clockwise positive.
double turnBetween(const Wall& before, const Wall& after) {
  const Eigen::Vector2d d0 = before.b - before.a, d1 = after.b - after.a;
  return wrapAngle(std::atan2(d1.y(), d1.x()) - std::atan2(d0.y(), d0.x()));
}

}  // namespace

Face uprightFace(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double bottom, double top,
                 std::size_t material) {
  Face face;
  face.origin = atHeight(b, bottom);
  face.along = atHeight(a, bottom) - face.origin;
  face.up = {0.0, 0.0, top - bottom};
  face.material = material;
  return face;
}

std::size_t materialNamed(const World& world, const char* name) {
  std::size_t index = 0;
  while (world.materials[index].name != name) ++index;
  return index;
}

std::vector<Face> doorHead(const World& world, const Door& door) {
  std::vector<Face> faces;
  const Wall& wall = world.walls[door.wall];
  const WallPlace place(wall);
  const double inner = 0.5 * door.width_m;
  const double outer = inner + door.frame_m;
  const double protrusion = door.frame_m > 0.0 ? door.protrusion_m : 0.0;
  const double top = door.height_m + door.frame_m;
  const auto upright = [&](double from, double to, double t, double bottom, double up_to,
                           std::size_t material) {
    faces.push_back(uprightFace(place.at(door.at_m + from, t), place.at(door.at_m + to, t), bottom,
                                up_to, material));
  };
  const auto level = [&](double reach, double t0, double t1, double z, std::size_t material) {
    Face face;
    face.origin = atHeight(place.at(door.at_m - reach, t0), z);
    face.along = atHeight(place.at(door.at_m + reach, t0), z) - face.origin;
    face.up = atHeight(place.at(door.at_m - reach, t1), z) - face.origin;
    face.material = material;
    if (face.along.norm() > 0.0 && face.up.norm() > 0.0) faces.push_back(face);
  };
  upright(-outer, outer, 0.0, top, wall.height_m, wall.material);
  if (door.frame_m > 0.0) {
    upright(-outer, outer, protrusion, door.height_m, top, door.frame_material);
    level(outer, 0.0, protrusion, top, door.frame_material);
  }
  level(inner, protrusion, -door.recess_m, door.height_m, door.frame_material);
  if (!door.through && world.materials[door.material].surface == Surface::kGlass) {
    const double t = -door.recess_m + kOffM;
    upright(-inner, -inner + kRimM, t, 0.0, door.height_m, door.frame_material);
    upright(inner - kRimM, inner, t, 0.0, door.height_m, door.frame_material);
    upright(-inner + kRimM, inner - kRimM, t, door.height_m - kRimM, door.height_m,
            door.frame_material);
    upright(-inner + kRimM, inner - kRimM, t, 0.0, 2.0 * kRimM, door.frame_material);
  }
  return faces;
}

std::vector<Face> boardFaces(const World& world, const Board& board) {
  const WallPlace place(world.walls[board.wall]);
  const Eigen::Vector2d a = place.at(board.at_m - 0.5 * board.width_m, 0.0);
  const Eigen::Vector2d b = place.at(board.at_m + 0.5 * board.width_m, 0.0);
  const Eigen::Vector2d t = board.thickness_m * place.out;
  const double top = board.bottom_m + board.height_m;
  const std::size_t rim = materialNamed(world, "frame");
  std::vector<Face> faces = {uprightFace(a + t, b + t, board.bottom_m, top, board.material),
                             uprightFace(a, a + t, board.bottom_m, top, rim),
                             uprightFace(b + t, b, board.bottom_m, top, rim)};
  for (const double z : {board.bottom_m, top}) {
    Face face;
    face.origin = atHeight(a, z);
    face.along = atHeight(b, z) - face.origin;
    face.up = atHeight(a + t, z) - face.origin;
    face.material = rim;
    faces.push_back(face);
  }
  return faces;
}

SkirtingBoard::SkirtingBoard(const World& world, std::size_t wall) : wall_(world.walls[wall]) {
  const WallPlace place(wall_);
  along_ = place.along;
  out_ = place.out;
  for (const auto& other : world.walls) {
    if (&other == &wall_) continue;
    const auto shift = [&](double turn) {
      return wall_.skirting_out_m * std::tan(std::clamp(0.5 * turn, -1.1, 1.1));
    };
    if ((other.b - wall_.a).norm() < kSamePlaceM) at_start_m_ = shift(turnBetween(other, wall_));
    if ((other.a - wall_.b).norm() < kSamePlaceM) at_end_m_ = shift(turnBetween(wall_, other));
  }
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> SkirtingBoard::frontOf(const Eigen::Vector2d& a,
                                                                   const Eigen::Vector2d& b) const {
  Eigen::Vector2d from = a + wall_.skirting_out_m * out_;
  Eigen::Vector2d to = b + wall_.skirting_out_m * out_;
  if ((a - wall_.a).norm() < kSamePlaceM) from += at_start_m_ * along_;
  if ((b - wall_.b).norm() < kSamePlaceM) to -= at_end_m_ * along_;
  return {from, to};
}

std::vector<Face> SkirtingBoard::faces(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const auto [from, to] = frontOf(a, b);
  const std::size_t material = wall_.skirting_material;
  const double top = wall_.skirting_m;
  std::vector<Face> faces = {uprightFace(from, to, 0.0, top, material)};
  // The ends, a little inside: most of them lie against something.
  const Eigen::Vector2d in = 0.001 * along_;
  faces.push_back(uprightFace(a + in, from + in, 0.0, top, material));
  faces.push_back(uprightFace(to - in, b - in, 0.0, top, material));
  Face lid;
  lid.origin = atHeight(to, top);
  lid.along = atHeight(from, top) - lid.origin;
  lid.up = atHeight(-wall_.skirting_out_m * out_, 0.0);
  lid.material = material;
  faces.push_back(lid);
  return faces;
}

}  // namespace colonnade
