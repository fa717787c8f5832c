// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "colonnade/base/text.hpp"
#include "world_statements.hpp"

namespace colonnade {
namespace {

constexpr double kLeafM = 0.04;
constexpr double kThickestWallM = 1.5;  ///< through which a door can lead

std::size_t wallOf(Statement& s, const World& world, const char* key) {
  const auto name = s.text(key, "");
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    if (world.walls[i].name == name) return i;
  }
  s.fail(std::string(key) + "=" + name + ": no such wall; name one that was defined above");
}

void onWallAt(Statement& s, const World& world, std::size_t index, double at_m, double width_m) {
  const auto& wall = world.walls[index];
  if (at_m - 0.5 * width_m >= 0.0 && at_m + 0.5 * width_m <= wall.length()) return;
  s.fail("does not fit: wall " + wall.name + " is " + formatFixed(wall.length(), 3) +
         " m long, this reaches from " + formatFixed(at_m - 0.5 * width_m, 3) + " to " +
         formatFixed(at_m + 0.5 * width_m, 3) + " m");
}

void checkOnWall(Statement& s, const World& world, const Door& door) {
  onWallAt(s, world, door.wall, door.at_m, door.width_m + 2.0 * door.frame_m);
  if (door.height_m + door.frame_m >= world.walls[door.wall].height_m) {
    s.fail("is as high as wall " + world.walls[door.wall].name);
  }
}

/// The door behind a door, in the wall it leads into; makes both as deep as half the distance.
Door doorBehind(Statement& s, const World& world, Door& door, std::size_t behind) {
  const Wall& front = world.walls[door.wall];
  const Wall& back = world.walls[behind];
  const Eigen::Vector2d along = (front.b - front.a) / front.length();
  const Eigen::Vector2d out(-along.y(), along.x());
  const Eigen::Vector2d along_back = (back.b - back.a) / back.length();
  const double depth = -(back.a - front.a).dot(out);
  if (along.dot(along_back) > -0.9999 || depth < -1e-6 || depth > kThickestWallM) {
    s.fail("into=" + back.name + ": that wall must run behind wall " + front.name +
           ", the other way, at most " + formatFixed(kThickestWallM, 1) + " m away");
  }
  Door twin = door;
  twin.wall = behind;
  twin.at_m = (front.a + door.at_m * along - back.a).dot(along_back);
  // A shut leaf has two faces, a leaf's thickness apart.
  const double leaf = door.through ? 0.0 : kLeafM;
  twin.recess_m = door.recess_m = std::max(0.0, 0.5 * (depth - leaf));
  twin.leaf.reset();
  const double protrusion = door.frame_m > 0.0 ? door.protrusion_m : 0.0;
  if (door.leaf) door.leaf->depth_m = depth + protrusion;
  return twin;
}

}  // namespace

void readDoor(Statement& s, World& world) {
  Door read;
  read.wall = wallOf(s, world, "wall");
  s.number("at_m", read.at_m, {0, 1e4}, "");
  s.number("width_m", read.width_m, {0.2, 10}, "");
  s.number("height_m", read.height_m, {0.5, 10}, "");
  s.number("recess_m", read.recess_m, {0, 2}, "");
  s.number("frame_m", read.frame_m, {0, 0.5}, "");
  s.number("protrusion_m", read.protrusion_m, {0, 0.5}, "");
  read.material = materialOf(s, world, "material", "wood");
  read.frame_material = materialOf(s, world, "frame", "frame");
  std::string state = "closed", hinge = "right";
  s.choice("state", state, {"closed", "open", "passage"}, "");
  s.choice("hinge", hinge, {"left", "right"}, "");
  OpenLeaf leaf;
  s.angle("open_deg", leaf.angle, {5, 175}, "");
  leaf.hinge_left = hinge == "left";
  read.through = state != "closed";
  read.where = s.where();
  if (state == "open") read.leaf = leaf;
  if (s.has("into") && s.has("recess_m")) {
    s.fail("recess_m follows from the distance of the two walls; leave it out");
  }
  const auto behind = s.text("into", "");
  const bool leads_on = s.has("into");
  const std::size_t back = leads_on ? wallOf(s, world, "into") : 0;
  s.finish(0);
  if (read.through && !leads_on) {
    s.fail("state=" + state + " needs into=WALL, the wall of the room behind");
  }
  checkOnWall(s, world, read);
  if (leads_on) {
    const Door twin = doorBehind(s, world, read, back);
    checkOnWall(s, world, twin);
    world.doors.push_back(twin);
  }
  world.doors.push_back(read);
}

void readPilaster(Statement& s, World& world) {
  Pilaster read;
  read.wall = wallOf(s, world, "wall");
  s.number("at_m", read.at_m, {0, 1e4}, "");
  s.number("width_m", read.width_m, {0.02, 10}, "");
  s.number("depth_m", read.depth_m, {0.005, 5}, "");
  read.material = materialOf(s, world, "material", "concrete");
  s.finish(0);
  read.where = s.where();
  onWallAt(s, world, read.wall, read.at_m, read.width_m);
  world.pilasters.push_back(read);
}

void readBoard(Statement& s, World& world) {
  Board read;
  read.wall = wallOf(s, world, "wall");
  s.number("at_m", read.at_m, {0, 1e4}, "");
  s.number("width_m", read.width_m, {0.05, 20}, "");
  s.number("bottom_m", read.bottom_m, {0.02, 10}, "");
  s.number("height_m", read.height_m, {0.05, 10}, "");
  s.number("thickness_m", read.thickness_m, {0.002, 0.5}, "");
  read.material = materialOf(s, world, "material", "cork");
  s.finish(0);
  onWallAt(s, world, read.wall, read.at_m, read.width_m);
  world.boards.push_back(read);
}

}  // namespace colonnade
