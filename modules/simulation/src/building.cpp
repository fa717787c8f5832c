// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/building.hpp"

#include <algorithm>
#include <cmath>

#include "profile.hpp"

namespace colonnade {
namespace {

constexpr double kSamePlaceM = 1e-3;  ///< metres within which two wall ends meet
constexpr double kHiddenConcaveM =
    0.06;  ///< a concave edge this near to a convex one is not listed

Eigen::Vector3d atHeight(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

/// An upright face over the line from a to b, seen from the left of that line.
Face uprightFace(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double bottom, double top,
                 std::size_t material) {
  Face face;
  face.origin = atHeight(b, bottom);
  face.along = atHeight(a, bottom) - face.origin;
  face.up = {0.0, 0.0, top - bottom};
  face.material = material;
  return face;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

class Builder {
 public:
  explicit Builder(const World& world) : world_(world) {}

  Building build() {
    bounds();
    for (std::size_t i = 0; i < world_.walls.size(); ++i) addWall(i);
    for (const auto& pillar : world_.pillars) {
      add(pillarProfile(pillar), nullptr, true);
      building_.faces.push_back(lid(pillar));
    }
    for (const auto& door : world_.doors) addDoorHead(door);
    for (const auto& board : world_.boards) addBoard(board);
    addWallCorners();
    addFloorAndCeiling();
    for (auto& face : building_.faces) face.surface = world_.materials[face.material].surface;
    return std::move(building_);
  }

 private:
  void bounds() {
    building_.low = building_.high = world_.walls.front().a;
    for (const auto& wall : world_.walls) {
      for (const auto& p : {wall.a, wall.b}) {
        building_.low = building_.low.cwiseMin(p);
        building_.high = building_.high.cwiseMax(p);
      }
      building_.ceiling_m = std::max(building_.ceiling_m, wall.height_m);
    }
    building_.low.array() -= 0.5;
    building_.high.array() += 0.5;
  }

  void addWall(std::size_t index) {
    const Wall& wall = world_.walls[index];
    add(wallProfile(world_, index), &wall, false);
  }

  /// Draws a profile and lists its edges and floor lines. `closed`: the last piece meets the first.
  void add(const Profile& profile, const Wall* wall, bool closed) {
    const auto& pieces = profile.pieces;
    for (const auto& piece : pieces) {
      Face face = uprightFace(piece.a, piece.b, 0.0, piece.height_m, piece.material);
      if (piece.skirting && wall && wall->skirting_m > 0.0) {
        face.skirting_m = wall->skirting_m;
        face.skirting_material = wall->skirting_material;
      }
      building_.faces.push_back(face);
      const FloorLine line{piece.a, piece.b, wall ? wall->hallway : -1};
      building_.outline.push_back(line);
      if ((line.b - line.a).norm() >= kNarrowFaceM) building_.floor_lines.push_back(line);
    }
    std::vector<std::optional<std::size_t>> edge_of_piece(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i == 0 && !closed) continue;
      const std::size_t before = (i + pieces.size() - 1) % pieces.size();
      const auto edge = edgeBetween(pieces, before, i, wall);
      if (!edge) continue;
      edge_of_piece[i] = building_.edges.size();
      building_.edges.push_back(*edge);
    }
    for (const auto& [first, second] : profile.partners) {
      if (first >= pieces.size() || second >= pieces.size()) continue;
      const auto a = edge_of_piece[first];
      const auto b = edge_of_piece[second];
      if (!a || !b) continue;
      building_.edges[*a].partner = *b;
      building_.edges[*b].partner = *a;
    }
  }

  std::optional<VerticalEdge> edgeBetween(const std::vector<ProfilePiece>& pieces,
                                          std::size_t before, std::size_t after,
                                          const Wall* wall) const {
    const Eigen::Vector2d d0 = pieces[before].b - pieces[before].a;
    const Eigen::Vector2d d1 = pieces[after].b - pieces[after].a;
    const double sine = cross(d0.normalized(), d1.normalized());
    const bool straight = std::abs(sine) < 0.01 && d0.dot(d1) > 0.0;
    if (straight && pieces[before].material == pieces[after].material) return std::nullopt;
    const bool concave = sine > 0.01;
    // The foot of a door frame that stands out a little: its convex edge speaks for both.
    if (concave && std::min(d0.norm(), d1.norm()) < kHiddenConcaveM) return std::nullopt;
    VerticalEdge edge;
    edge.p_world = pieces[after].a;
    edge.height_m = std::min(pieces[before].height_m, pieces[after].height_m);
    edge.convex = !concave;
    edge.slope = !straight && std::min(d0.norm(), d1.norm()) >= kNarrowFaceM;
    edge.hallway = wall ? wall->hallway : -1;
    return edge;
  }

  static Face lid(const Pillar& pillar) {
    const auto outline = pillarProfile(pillar).pieces;
    Face face;
    face.origin = atHeight(outline[0].a, pillar.height_m);
    face.along = atHeight(outline[3].a, pillar.height_m) - face.origin;
    face.up = atHeight(outline[1].a, pillar.height_m) - face.origin;
    face.material = pillar.material;
    return face;
  }

  /// The wall above a door, the head of its frame and the soffit of the opening.
  void addDoorHead(const Door& door) {
    const Wall& wall = world_.walls[door.wall];
    const Eigen::Vector2d along = (wall.b - wall.a) / wall.length();
    const Eigen::Vector2d out(-along.y(), along.x());
    const auto place = [&](double s, double t) -> Eigen::Vector2d {
      return wall.a + s * along + t * out;
    };
    const double outer = 0.5 * door.width_m + door.frame_m;
    const double protrusion = door.frame_m > 0.0 ? door.protrusion_m : 0.0;
    const double top = door.height_m + door.frame_m;
    const auto upright = [&](double reach, double t, double bottom, double up_to,
                             std::size_t material) {
      building_.faces.push_back(uprightFace(place(door.at_m - reach, t),
                                            place(door.at_m + reach, t), bottom, up_to, material));
    };
    const auto level = [&](double reach, double t0, double t1, double z, std::size_t material) {
      Face face;
      face.origin = atHeight(place(door.at_m - reach, t0), z);
      face.along = atHeight(place(door.at_m + reach, t0), z) - face.origin;
      face.up = atHeight(place(door.at_m - reach, t1), z) - face.origin;
      face.material = material;
      if (face.along.norm() > 0.0 && face.up.norm() > 0.0) building_.faces.push_back(face);
    };
    upright(outer, 0.0, top, wall.height_m, wall.material);
    if (door.frame_m > 0.0) {
      upright(outer, protrusion, door.height_m, top, door.frame_material);
      level(outer, 0.0, protrusion, top, door.frame_material);
    }
    level(0.5 * door.width_m, protrusion, -door.recess_m, door.height_m, door.frame_material);
  }

  void addBoard(const Board& board) {
    const Wall& wall = world_.walls[board.wall];
    const Eigen::Vector2d along = (wall.b - wall.a) / wall.length();
    const Eigen::Vector2d out(-along.y(), along.x());
    const Eigen::Vector2d a = wall.a + (board.at_m - 0.5 * board.width_m) * along;
    const Eigen::Vector2d b = a + board.width_m * along;
    const Eigen::Vector2d t = board.thickness_m * out;
    const double top = board.bottom_m + board.height_m;
    const std::size_t rim = materialNamed("frame");
    building_.faces.push_back(uprightFace(a + t, b + t, board.bottom_m, top, board.material));
    building_.faces.push_back(uprightFace(a, a + t, board.bottom_m, top, rim));
    building_.faces.push_back(uprightFace(b + t, b, board.bottom_m, top, rim));
    for (const double z : {board.bottom_m, top}) {
      Face face;
      face.origin = atHeight(a, z);
      face.along = atHeight(b, z) - face.origin;
      face.up = atHeight(a + t, z) - face.origin;
      face.material = rim;
      building_.faces.push_back(face);
    }
  }

  /// Where one wall ends and another begins, and where a wall ends in the open.
  void addWallCorners() {
    const auto& walls = world_.walls;
    std::vector<bool> starts_at_other(walls.size(), false);
    for (const auto& wall : walls) {
      const Wall* next = nullptr;
      for (std::size_t j = 0; j < walls.size(); ++j) {
        if ((walls[j].a - wall.b).norm() > kSamePlaceM) continue;
        next = &walls[j];
        starts_at_other[j] = true;
        break;
      }
      VerticalEdge edge{wall.b, wall.height_m, true, false, std::nullopt, wall.hallway};
      if (next) {
        const double sine =
            cross((wall.b - wall.a) / wall.length(), (next->b - next->a) / next->length());
        if (std::abs(sine) < 0.02) continue;
        edge.height_m = std::min(wall.height_m, next->height_m);
        edge.convex = sine < 0.0;
        edge.slope = true;
      }
      building_.edges.push_back(edge);
    }
    for (std::size_t j = 0; j < walls.size(); ++j) {
      if (starts_at_other[j]) continue;
      building_.edges.push_back(
          {walls[j].a, walls[j].height_m, true, false, std::nullopt, walls[j].hallway});
    }
  }

  void addFloorAndCeiling() {
    const Eigen::Vector2d size = building_.high - building_.low;
    Face floor;
    floor.origin = atHeight(building_.low, 0.0);
    floor.along = {size.x(), 0.0, 0.0};
    floor.up = {0.0, size.y(), 0.0};
    floor.material = world_.floor_material;
    building_.faces.push_back(floor);

    Face ceiling;
    ceiling.origin = {building_.low.x(), building_.high.y(), building_.ceiling_m};
    ceiling.along = {size.x(), 0.0, 0.0};
    ceiling.up = {0.0, -size.y(), 0.0};
    ceiling.material = world_.ceiling_material;
    building_.faces.push_back(ceiling);

    for (const auto& lamp : world_.lamps) {
      Face face;
      const Eigen::Vector2d corner =
          lamp.centre + Eigen::Vector2d(-0.5, 0.5).cwiseProduct(lamp.size);
      face.origin = atHeight(corner, building_.ceiling_m - 0.01);
      face.along = {lamp.size.x(), 0.0, 0.0};
      face.up = {0.0, -lamp.size.y(), 0.0};
      face.material = materialNamed("lamp");
      face.glows = true;
      building_.faces.push_back(face);
    }
  }

  /// A material every world has.
  std::size_t materialNamed(const char* name) const {
    std::size_t index = 0;
    while (world_.materials[index].name != name) ++index;
    return index;
  }

  const World& world_;
  Building building_;
};

}  // namespace

Building buildBuilding(const World& world) { return Builder(world).build(); }

}  // namespace colonnade
