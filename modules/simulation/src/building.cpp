// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/building.hpp"

#include <algorithm>
#include <cmath>

#include "fittings.hpp"
#include "profile.hpp"
#include "solids.hpp"

namespace colonnade {
namespace {

constexpr double kSamePlaceM = 1e-3;  ///< metres within which two wall ends meet
constexpr double kHiddenConcaveM =
    0.06;  ///< a concave edge this near to a convex one is not listed

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Rounding must not decide about faces of just that width, such as door frames.
bool isWide(const Eigen::Vector2d& face) { return face.norm() >= kNarrowFaceM - 1e-6; }

class Builder {
 public:
  explicit Builder(const World& world) : world_(world) {}

  Building build() {
    bounds();
    for (std::size_t i = 0; i < world_.walls.size(); ++i) addWall(i);
    for (const auto& solid : solidsOf(world_)) addSolid(solid);
    for (const auto& door : world_.doors) addFaces(doorHead(world_, door), Belonging::kFixture);
    for (const auto& board : world_.boards)
      addFaces(boardFaces(world_, board), Belonging::kFixture);
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
    const Profile profile = wallProfile(world_, index);
    const SkirtingBoard board(world_, index);
    for (const auto& piece : profile.pieces) {
      if (piece.gap) {
        building_.gaps.push_back({piece.a, piece.b, wall.hallway, piece.height_m});
        continue;
      }
      addObstacle("wall " + wall.name, {piece.a, piece.b}, false, 0.0);
      Face face = uprightFace(piece.a, piece.b, 0.0, piece.height_m, piece.material);
      const bool has_board = piece.skirting && wall.skirting_m > 0.0;
      if (has_board && wall.skirting_out_m > 0.0) {
        const auto [a, b] = board.frontOf(piece.a, piece.b);
        addFaces(board.faces(piece.a, piece.b), Belonging::kBuilding);
        addFloorLine({a, b, wall.hallway, piece.height_m});
      } else {
        addFloorLine({piece.a, piece.b, wall.hallway, piece.height_m});
        if (has_board) {
          face.skirting_m = wall.skirting_m;
          face.skirting_material = wall.skirting_material;
        }
      }
      building_.faces.push_back(face);
    }
    addEdges(profile, false, wall.hallway);
  }

  void addSolid(const Solid& solid) {
    const std::size_t n = solid.outline.size();
    Profile profile;
    for (std::size_t i = 0; i < n; ++i) {
      profile.pieces.push_back(
          {solid.outline[i], solid.outline[(i + 1) % n], solid.top_m, solid.material});
      const auto& piece = profile.pieces.back();
      building_.faces.push_back(
          uprightFace(piece.a, piece.b, solid.bottom_m, solid.top_m, solid.material));
      building_.faces.back().belonging = solid.belonging;
      if (!solid.standing()) continue;
      const FloorLine line{piece.a, piece.b, -1, solid.top_m};
      building_.outline.push_back(line);
      if (!solid.round) addFloorLine(line, false);
    }
    addObstacle(solid.name, solid.outline, true, solid.bottom_m);
    if (solid.round) return;
    building_.faces.push_back(lid(solid, solid.top_m));
    if (!solid.standing()) building_.faces.push_back(lid(solid, solid.bottom_m));
    profile.partners = {{0, 1}, {2, 3}};
    if (solid.standing()) addEdges(profile, true, -1, solid.belonging);
  }

  void addFaces(std::vector<Face> faces, Belonging belonging) {
    for (auto& face : faces) face.belonging = belonging;
    building_.faces.insert(building_.faces.end(), faces.begin(), faces.end());
  }

  void addObstacle(const std::string& name, std::vector<Eigen::Vector2d> outline, bool solid,
                   double bottom_m) {
    building_.obstacles.push_back({name, std::move(outline), solid, bottom_m});
  }

  void addFloorLine(const FloorLine& line, bool of_outline = true) {
    if (of_outline) building_.outline.push_back(line);
    if (isWide(line.b - line.a)) building_.floor_lines.push_back(line);
  }

  /// Lists the edges of a profile. `closed`: the last piece meets the first.
  void addEdges(const Profile& profile, bool closed, int hallway,
                Belonging belonging = Belonging::kBuilding) {
    const auto& pieces = profile.pieces;
    std::vector<std::optional<std::size_t>> edge_of_piece(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i == 0 && !closed) continue;
      const std::size_t before = (i + pieces.size() - 1) % pieces.size();
      const auto edge = edgeBetween(pieces, before, i, hallway);
      if (!edge) continue;
      edge_of_piece[i] = building_.edges.size();
      building_.edges.push_back(*edge);
      building_.edges.back().belonging = belonging;
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
                                          int hallway) const {
    // In the middle of an opening the jamb goes on in the wall behind.
    if (pieces[before].gap || pieces[after].gap) return std::nullopt;
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
    edge.slope = !straight && isWide(d0) && isWide(d1);
    edge.hallway = hallway;
    return edge;
  }

  static Face lid(const Solid& solid, double z) {
    Face face;
    face.origin = atHeight(solid.outline[0], z);
    face.along = atHeight(solid.outline[3], z) - face.origin;
    face.up = atHeight(solid.outline[1], z) - face.origin;
    face.material = solid.material;
    return face;
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
      face.material = materialNamed(world_, "lamp");
      face.glows = true;
      building_.faces.push_back(face);
    }
  }

  const World& world_;
  Building building_;
};

}  // namespace

Building buildBuilding(const World& world) { return Builder(world).build(); }

}  // namespace colonnade
