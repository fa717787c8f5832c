// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "world_statements.hpp"

namespace colonnade {

void readPillar(Statement& s, World& world) {
  Pillar read;
  read.centre = s.point(0, "the centre");
  s.pair("size_m", read.size, {0.02, 10});
  s.angle("turn_deg", read.turn, {-180, 180}, "");
  s.number("height_m", read.height_m, {0.1, 20}, "");
  read.material = materialOf(s, world, "material", "concrete");
  s.finish(2);
  read.where = s.where();
  world.pillars.push_back(read);
}

void readColumn(Statement& s, World& world) {
  Pillar read;
  read.round = true;
  read.centre = s.point(0, "the centre");
  s.number("diameter_m", read.size.x(), {0.02, 10}, "");
  read.size.y() = read.size.x();
  s.number("height_m", read.height_m, {0.1, 20}, "");
  read.material = materialOf(s, world, "material", "concrete");
  s.finish(2);
  read.where = s.where();
  world.pillars.push_back(read);
}

namespace {

void readFurniture(Statement& s, World& world, Furniture read, const char* material,
                   const char* leg) {
  read.centre = s.point(0, "the centre");
  s.pair("size_m", read.size, {0.1, 10});
  s.number("height_m", read.height_m, {0.1, 3}, "");
  s.angle("turn_deg", read.turn, {-180, 180}, "");
  read.material = materialOf(s, world, "material", material);
  read.leg_material = leg ? materialOf(s, world, "legs", leg) : read.material;
  s.finish(2);
  read.where = s.where();
  world.furniture.push_back(read);
}

}  // namespace

void readTable(Statement& s, World& world) {
  readFurniture(s, world, {.kind = Furniture::Kind::kTable}, "wood", "frame");
}

void readChair(Statement& s, World& world) {
  readFurniture(s, world, {.kind = Furniture::Kind::kChair, .size = {0.44, 0.44}, .height_m = 0.86},
                "fabric", "frame");
}

void readCabinet(Statement& s, World& world) {
  readFurniture(s, world,
                {.kind = Furniture::Kind::kCabinet, .size = {0.45, 0.9}, .height_m = 1.25}, "wood",
                nullptr);
}

void readBin(Statement& s, World& world) {
  readFurniture(s, world, {.kind = Furniture::Kind::kBin, .size = {0.3, 0.3}, .height_m = 0.55},
                "skirting", nullptr);
}

void readWalker(Statement& s, World& world) {
  Walker read;
  const std::size_t points = s.wordCount() / 2;
  for (std::size_t i = 0; i < points; ++i) read.waypoints.push_back(s.point(2 * i, "a waypoint"));
  s.number("speed_m_per_s", read.speed_m_per_s, {0, 5}, "");
  s.number("phase_s", read.phase_s, {0, 3600}, "");
  s.flag("round", read.round, "");
  s.number("height_m", read.height_m, {0.5, 2.5}, "");
  s.triple("clothes", read.clothes, {0, 255});
  s.triple("trousers", read.trousers, {0, 255});
  s.finish(2 * points);
  if (points < 2) s.fail("needs two waypoints or more, X1 Y1 X2 Y2 ...");
  for (std::size_t i = 1; i < points; ++i) {
    if ((read.waypoints[i] - read.waypoints[i - 1]).norm() < 0.01) {
      s.fail("two waypoints in the same place; remove one");
    }
  }
  read.where = s.where();
  world.walkers.push_back(read);
}

}  // namespace colonnade
