// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/text.hpp"
#include "world_statements.hpp"

namespace colonnade {
namespace {

const std::vector<std::pair<std::string, Surface>> kSurfaces = {
    {"opaque", Surface::kOpaque}, {"glass", Surface::kGlass}, {"mirror", Surface::kMirror}};

const std::vector<std::pair<std::string, Pattern>> kPatterns = {
    {"plaster", Pattern::kPlaster}, {"tiles", Pattern::kTiles},   {"panels", Pattern::kPanels},
    {"papers", Pattern::kPapers},   {"sheets", Pattern::kSheets}, {"decals", Pattern::kDecals},
    {"plain", Pattern::kPlain},     {"lamp", Pattern::kLamp}};

/// A key whose value is one of a list of names.
template <typename T>
void readNamed(Statement& s, const char* key, T& value,
               const std::vector<std::pair<std::string, T>>& names) {
  std::vector<std::string> allowed;
  std::string chosen;
  for (const auto& [name, meaning] : names) {
    allowed.push_back(name);
    if (meaning == value) chosen = name;
  }
  s.choice(key, chosen, allowed, "");
  for (const auto& [name, meaning] : names) {
    if (name == chosen) value = meaning;
  }
}

void wallOptions(Statement& s, const World& world, Wall& wall) {
  s.number("height_m", wall.height_m, {0.1, 20}, "");
  s.number("skirting_m", wall.skirting_m, {0, 1}, "");
  s.number("skirting_out_m", wall.skirting_out_m, {0, 0.1}, "");
  s.integer("hallway", wall.hallway, {-1, 1000}, "");
  wall.material = materialOf(s, world, "material", "plaster");
  wall.skirting_material = materialOf(s, world, "skirting", "skirting");
  wall.where = s.where();
}

void addWall(Statement& s, World& world, const Wall& wall) {
  if (wall.length() < 0.01) s.fail("wall " + wall.name + " is shorter than 1 cm");
  for (const auto& other : world.walls) {
    if (other.name == wall.name) s.fail("there is a wall named " + wall.name + " already");
  }
  world.walls.push_back(wall);
}

}  // namespace

std::size_t materialIndex(const World& world, const std::string& name) {
  std::size_t index = 0;
  while (index < world.materials.size() && world.materials[index].name != name) ++index;
  return index;
}

std::size_t materialOf(Statement& s, const World& world, const char* key, const char* otherwise) {
  const auto name = s.text(key, otherwise);
  const auto index = materialIndex(world, name);
  if (index == world.materials.size()) {
    s.fail(std::string(key) + "=" + name + ": no such material; define it with 'material' first");
  }
  return index;
}

void addBuiltInMaterials(World& world) {
  const auto surface = [&](const char* name, Pattern pattern, Eigen::Vector3d colour,
                           Eigen::Vector3d second, double tile_m) {
    Material material;
    material.name = name;
    material.pattern = pattern;
    material.colour = colour;
    material.second = second;
    material.tile_m = tile_m;
    world.materials.push_back(material);
  };
  surface("plaster", Pattern::kPlaster, {205, 200, 188}, {150, 145, 135}, 0.3);
  surface("skirting", Pattern::kPlain, {92, 84, 78}, {60, 55, 50}, 0.3);
  surface("wood", Pattern::kPanels, {150, 112, 76}, {96, 68, 44}, 0.3);
  surface("frame", Pattern::kPlain, {84, 92, 100}, {60, 60, 60}, 0.3);
  surface("concrete", Pattern::kPlaster, {158, 158, 154}, {120, 120, 120}, 0.3);
  surface("cork", Pattern::kPapers, {172, 138, 96}, {232, 232, 226}, 0.3);
  surface("tiles", Pattern::kTiles, {150, 148, 140}, {104, 102, 98}, 0.45);
  surface("ceiling", Pattern::kTiles, {214, 214, 210}, {170, 170, 168}, 0.62);
  surface("fabric", Pattern::kPlaster, {62, 74, 104}, {60, 60, 60}, 0.3);
  surface("lamp", Pattern::kLamp, {252, 252, 248}, {214, 214, 210}, 0.3);
  surface("glass", Pattern::kPlain, {172, 190, 188}, {120, 120, 120}, 0.3);
  world.materials.back().surface = Surface::kGlass;
  surface("mirror", Pattern::kPlain, {198, 204, 206}, {120, 120, 120}, 0.3);
  world.materials.back().surface = Surface::kMirror;
  world.floor_material = materialIndex(world, "tiles");
  world.ceiling_material = materialIndex(world, "ceiling");
}

void readMaterial(Statement& s, World& world) {
  Material read;
  const auto name = s.word(0, "the name");
  const auto index = materialIndex(world, name);
  if (index < world.materials.size()) read = world.materials[index];
  read.name = name;
  readNamed(s, "pattern", read.pattern, kPatterns);
  readNamed(s, "surface", read.surface, kSurfaces);
  s.number("opacity", read.opacity, {0, 1}, "of glass");
  s.number("gloss", read.gloss, {0, 0.9}, "of a floor");
  s.triple("colour", read.colour, {0, 255});
  s.triple("second", read.second, {0, 255});
  s.number("grain", read.grain, {0, 100}, "gray levels of fine noise");
  s.number("blotches", read.blotches, {0, 100}, "gray levels of coarse noise");
  s.number("tile_m", read.tile_m, {0.02, 10}, "edge of a tile");
  s.finish(1);
  if (index < world.materials.size()) {
    world.materials[index] = read;
  } else {
    world.materials.push_back(read);
  }
}

void readWall(Statement& s, World& world) {
  Wall read;
  read.name = s.word(0, "the name");
  read.a = s.point(1, "the start");
  read.b = s.point(3, "the end");
  wallOptions(s, world, read);
  s.finish(5);
  addWall(s, world, read);
}

void readRoom(Statement& s, World& world) {
  Wall read;
  const auto name = s.word(0, "the name");
  const auto corners = (s.wordCount() - 1) / 2;
  if (corners < 3) s.fail("needs at least three corners");
  wallOptions(s, world, read);
  s.finish(1 + 2 * corners);
  for (std::size_t i = 0; i < corners; ++i) {
    read.name = name + "." + std::to_string(i + 1);
    read.a = s.point(1 + 2 * i, "a corner");
    read.b = s.point(1 + 2 * ((i + 1) % corners), "a corner");
    addWall(s, world, read);
  }
}

void readLamp(Statement& s, World& world) {
  Lamp read;
  read.centre = s.point(0, "the centre");
  s.pair("size_m", read.size, {0.02, 10});
  s.number("brightness", read.brightness, {0, 10}, "");
  s.finish(2);
  world.lamps.push_back(read);
}

void readFloor(Statement& s, World& world) {
  world.floor_material = materialOf(s, world, "material", "tiles");
  s.finish(0);
}

void readCeiling(Statement& s, World& world) {
  world.ceiling_material = materialOf(s, world, "material", "ceiling");
  s.finish(0);
}

void readTexture(Statement& s, World& world) {
  s.number("texels_per_m", world.texels_per_m, {20, 1000}, "");
  s.finish(0);
}

}  // namespace colonnade
