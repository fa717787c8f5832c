// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "upright_lines.hpp"

#include <algorithm>
#include <cmath>

#include "painter.hpp"
#include "solids.hpp"

namespace colonnade {
namespace {

constexpr double kSamePlaceM = 1e-3;
constexpr double kShortestM = 0.1;  ///< nothing shorter is ever a landmark's line

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool isUpright(const Face& face) {
  return face.up.head<2>().norm() < 1e-9 && std::abs(face.along.z()) < 1e-9;
}

/// One side of a face.
struct Side {
  Eigen::Vector2d p;
  double bottom, top;
  const Face* face;
};

bool samePlace(const Side& a, const Side& b) { return (a.p - b.p).norm() < kSamePlaceM; }

/// Do two faces go on into one another without a trace, over the whole of the first one's side?
bool isSeam(const Side& a, const Side& b) {
  if (a.face == b.face || !samePlace(a, b)) return false;
  const Eigen::Vector2d d = a.face->along.head<2>().normalized();
  const Eigen::Vector2d e = b.face->along.head<2>().normalized();
  return std::abs(cross(d, e)) < 0.01 && d.dot(e) > 0.0 && a.face->material == b.face->material &&
         b.bottom < a.bottom + kSamePlaceM && b.top > a.top - kSamePlaceM;
}

class Collector {
 public:
  Collector(const World& world, const Building& building) : world_(world), building_(building) {}

  std::vector<UprightLine> collect() {
    std::vector<Side> sides;
    for (const auto& face : building_.faces) {
      if (!isUpright(face) || face.belonging == Belonging::kRound) continue;
      const double bottom = face.origin.z(), top = bottom + face.up.z();
      sides.push_back({face.origin.head<2>(), bottom, top, &face});
      sides.push_back({(face.origin + face.along).head<2>(), bottom, top, &face});
    }
    for (const auto& side : sides) {
      if (std::any_of(sides.begin(), sides.end(),
                      [&](const Side& other) { return isSeam(side, other); }))
        continue;
      // The rim of a glass door stands on the floor as its frame does.
      const bool building = side.face->belonging == Belonging::kBuilding ||
                            (side.face->belonging == Belonging::kFixture && side.bottom == 0.0);
      add({building ? "minor" : kindOf(side.face->belonging), side.p, side.bottom, side.top});
    }
    for (const auto& face : building_.faces)
      if (isUpright(face)) addPaint(face);
    return std::move(lines_);
  }

 private:
  void add(const UprightLine& line) {
    if (line.top_m - line.bottom_m < kShortestM) return;
    const auto same = [&](const Eigen::Vector2d& p, double bottom, double top) {
      return (p - line.p_world).norm() < kSamePlaceM && bottom < line.bottom_m + kSamePlaceM &&
             top > line.top_m - kSamePlaceM;
    };
    for (const auto& edge : building_.edges)
      if (same(edge.p_world, 0.0, edge.height_m)) return;
    for (const auto& other : lines_)
      if (same(other.p_world, other.bottom_m, other.top_m)) return;
    lines_.push_back(line);
  }

  void addPaint(const Face& face) {
    if (face.belonging == Belonging::kFurniture || face.belonging == Belonging::kRound) return;
    const Material& material = world_.materials[face.material];
    const double width = face.along.norm(), height = face.up.z();
    const bool wall = face.belonging == Belonging::kBuilding && face.origin.z() == 0.0;
    const auto mark = [&](double at, double bottom, double top) {
      const Eigen::Vector3d p = face.origin + at / width * face.along;
      const bool whole = wall && bottom == 0.0 && top == height;
      lines_.push_back(
          {whole ? "minor" : "mark", p.head<2>(), face.origin.z() + bottom, face.origin.z() + top});
    };
    if (material.pattern == Pattern::kSheets || material.pattern == Pattern::kTiles) {
      for (double at = material.tile_m; at < width; at += material.tile_m) mark(at, 0.0, height);
    }
    if (material.pattern != Pattern::kPanels) return;
    const double half = panelHalfWidth(width);
    if (half < 0.05) return;
    for (const auto& [low, high] : panelHeights(height)) {
      if (high <= low) continue;
      for (const double x : {-half, -half + kPanelLineM, half - kPanelLineM, half})
        mark(0.5 * width + x, low, high);
    }
  }

  const World& world_;
  const Building& building_;
  std::vector<UprightLine> lines_;
};

}  // namespace

const char* kindOf(Belonging belonging) {
  switch (belonging) {
    case Belonging::kBuilding:
      return "pillar";
    case Belonging::kRound:
      return "round";
    case Belonging::kFixture:
      return "fixture";
    case Belonging::kLeaf:
      return "leaf";
    case Belonging::kCabinet:
      return "cabinet";
    case Belonging::kFurniture:
      return "furniture";
  }
  return "";
}

std::vector<UprightLine> uprightLinesOf(const World& world, const Building& building) {
  return Collector(world, building).collect();
}

std::vector<RoundOutline> roundOutlinesOf(const World& world) {
  std::vector<RoundOutline> outlines;
  for (const auto& solid : solidsOf(world))
    if (solid.round) outlines.push_back({solid.outline, solid.top_m});
  return outlines;
}

std::vector<OutlineEnd> silhouette(const RoundOutline& outline, const Eigen::Vector2d& p_eye) {
  const std::size_t n = outline.corners.size();
  std::vector<OutlineEnd> ends(2);
  int found = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = outline.corners[i], &b = outline.corners[(i + 1) % n],
                          &c = outline.corners[(i + 2) % n];
    // A side of a clockwise outline faces those on its left.
    const bool before = cross(b - a, p_eye - a) > 0.0, after = cross(c - b, p_eye - b) > 0.0;
    if (before == after) continue;
    const std::size_t inner = before ? i + n - 1 : i + 3;  // two corners before or after b
    ends[before ? 0 : 1] = {b, outline.corners[inner % n]};
    ++found;
  }
  return found == 2 ? ends : std::vector<OutlineEnd>();
}

}  // namespace colonnade
