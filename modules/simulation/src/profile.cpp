// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// A door or pilaster: outline points (along the wall, out of the wall) from its first to its last
/// point on the wall, symmetric about its middle.
struct Feature {
  double begin = 0.0;
  double end = 0.0;
  std::vector<Eigen::Vector2d> outline;  ///< k points, k - 1 pieces
  std::vector<std::size_t> materials;    ///< of the pieces
  double height_m = 0.0;
  std::string what;
  bool through = false;  ///< the middle piece is a gap
};

Feature featureOf(const Pilaster& pilaster, const Wall& wall) {
  const double a = pilaster.at_m - 0.5 * pilaster.width_m;
  const double b = pilaster.at_m + 0.5 * pilaster.width_m;
  const double d = pilaster.depth_m;
  return {a,
          b,
          {{a, 0}, {a, d}, {b, d}, {b, 0}},
          std::vector<std::size_t>(3, pilaster.material),
          wall.height_m,
          "the pilaster of " + pilaster.where};
}

Feature featureOf(const Door& door) {
  Feature feature;
  const double inner = 0.5 * door.width_m;
  const double outer = inner + door.frame_m;
  const double out = door.frame_m > 0.0 ? door.protrusion_m : 0.0;
  const std::size_t frame = door.frame_material;
  std::vector<Eigen::Vector2d> half;  // from the wall to the leaf
  std::vector<std::size_t> pieces;
  if (out > 0.0) half.emplace_back(outer, 0.0);
  if (door.frame_m > 0.0) {
    if (out > 0.0) pieces.push_back(frame);
    half.emplace_back(outer, out);
    pieces.push_back(frame);
  }
  half.emplace_back(inner, out);
  if (door.recess_m + out > 0.0) {
    half.emplace_back(inner, -door.recess_m);
    pieces.push_back(frame);
  }
  for (const auto& p : half) feature.outline.emplace_back(door.at_m - p.x(), p.y());
  for (auto p = half.rbegin(); p != half.rend(); ++p) {
    feature.outline.emplace_back(door.at_m + p->x(), p->y());
  }
  feature.materials = pieces;
  feature.materials.push_back(door.material);
  feature.materials.insert(feature.materials.end(), pieces.rbegin(), pieces.rend());
  feature.begin = feature.outline.front().x();
  feature.end = feature.outline.back().x();
  feature.height_m = door.height_m;
  feature.what = "the door of " + door.where;
  feature.through = door.through;
  return feature;
}

}  // namespace

Profile wallProfile(const World& world, std::size_t wall_index) {
  const Wall& wall = world.walls[wall_index];
  std::vector<Feature> features;
  for (const auto& door : world.doors) {
    if (door.wall == wall_index) features.push_back(featureOf(door));
  }
  for (const auto& pilaster : world.pilasters) {
    if (pilaster.wall == wall_index) features.push_back(featureOf(pilaster, wall));
  }
  std::stable_sort(features.begin(), features.end(),
                   [](const Feature& a, const Feature& b) { return a.begin < b.begin; });

  const Eigen::Vector2d along = (wall.b - wall.a) / wall.length();
  const Eigen::Vector2d out(-along.y(), along.x());
  const auto place = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return wall.a + p.x() * along + p.y() * out;
  };
  Profile profile;
  double s = 0.0;
  std::string before;
  const auto plainUntil = [&](double end) {
    if (end - s > 1e-9) {
      profile.pieces.push_back(
          {place({s, 0}), place({end, 0}), wall.height_m, wall.material, true});
    }
  };
  for (const auto& feature : features) {
    if (feature.begin < s - 1e-9) {
      throw Error(before.substr(before.rfind(' ') + 1) + ": " + before + " and " + feature.what +
                      " overlap at " + formatFixed(feature.begin, 2) + " m of wall " + wall.name +
                      "; move one of them",
                  ExitCode::kUsage);
    }
    plainUntil(feature.begin);
    const std::size_t first = profile.pieces.size();
    const std::size_t last = feature.materials.size();  // index of the last outline point
    for (std::size_t i = 0; i < last; ++i) {
      profile.pieces.push_back({place(feature.outline[i]), place(feature.outline[i + 1]),
                                feature.height_m, feature.materials[i], false,
                                feature.through && 2 * i + 1 == last});
      if (i < last - i) profile.partners.emplace_back(first + i, first + last - i);
    }
    s = feature.end;
    before = feature.what;
  }
  plainUntil(wall.length());
  return profile;
}

}  // namespace colonnade
