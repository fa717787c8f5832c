// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "statement.hpp"

namespace colonnade {
namespace {

const std::vector<std::pair<std::string, Pattern>> kPatterns = {
    {"plaster", Pattern::kPlaster}, {"tiles", Pattern::kTiles}, {"panels", Pattern::kPanels},
    {"papers", Pattern::kPapers},   {"plain", Pattern::kPlain}, {"lamp", Pattern::kLamp}};

/// Turns statements into a world, one function per keyword.
class WorldReader {
 public:
  explicit WorldReader(std::string name) : name_(std::move(name)) {
    world_.name = std::filesystem::path(name_).stem().string();
    const auto surface = [&](const char* name, Pattern pattern, Eigen::Vector3d colour,
                             Eigen::Vector3d second, double tile_m) {
      world_.materials.push_back({name, pattern, colour, second, 4.0, 4.0, tile_m});
    };
    surface("plaster", Pattern::kPlaster, {205, 200, 188}, {150, 145, 135}, 0.3);
    surface("skirting", Pattern::kPlain, {92, 84, 78}, {60, 55, 50}, 0.3);
    surface("wood", Pattern::kPanels, {150, 112, 76}, {96, 68, 44}, 0.3);
    surface("frame", Pattern::kPlain, {84, 92, 100}, {60, 60, 60}, 0.3);
    surface("concrete", Pattern::kPlaster, {158, 158, 154}, {120, 120, 120}, 0.3);
    surface("cork", Pattern::kPapers, {172, 138, 96}, {232, 232, 226}, 0.3);
    surface("tiles", Pattern::kTiles, {150, 148, 140}, {104, 102, 98}, 0.45);
    surface("ceiling", Pattern::kTiles, {214, 214, 210}, {170, 170, 168}, 0.62);
    surface("lamp", Pattern::kLamp, {252, 252, 248}, {214, 214, 210}, 0.3);
    world_.floor_material = material("tiles");
    world_.ceiling_material = material("ceiling");
  }

  void read(std::istream& input) {
    std::string line;
    for (int number = 1; std::getline(input, line); ++number) {
      readLine(line, name_ + ":" + std::to_string(number));
    }
  }

  void readLine(const std::string& line, const std::string& where) {
    Statement statement(line, where);
    if (statement.keyword().empty()) return;
    const auto found = handlers_.find(statement.keyword());
    if (found == handlers_.end()) {
      std::vector<std::string> known;
      for (const auto& [keyword, handler] : handlers_) known.push_back(keyword);
      throw Error(
          where + ": unknown keyword '" + statement.keyword() + "'; known: " + joined(known, ", "),
          ExitCode::kUsage);
    }
    (this->*found->second)(statement);
  }

  World finished() {
    if (world_.walls.empty()) throw Error(name_ + ": has no wall; add one", ExitCode::kUsage);
    if (world_.route.steps.empty()) {
      throw Error(name_ + ": the robot has no route; add 'drive X Y'", ExitCode::kUsage);
    }
    return std::move(world_);
  }

 private:
  using Handler = void (WorldReader::*)(Statement&);

  std::size_t material(const std::string& name) const {
    for (std::size_t i = 0; i < world_.materials.size(); ++i) {
      if (world_.materials[i].name == name) return i;
    }
    return world_.materials.size();
  }

  std::size_t material(Statement& s, const char* key, const char* otherwise) const {
    const auto name = s.text(key, otherwise);
    const auto index = material(name);
    if (index == world_.materials.size()) {
      s.fail(std::string(key) + "=" + name + ": no such material; define it with 'material' first");
    }
    return index;
  }

  std::size_t wall(Statement& s) const {
    const auto name = s.text("wall", "");
    for (std::size_t i = 0; i < world_.walls.size(); ++i) {
      if (world_.walls[i].name == name) return i;
    }
    s.fail("wall=" + name + ": no such wall; name one that was defined above");
  }

  void onWallAt(Statement& s, std::size_t wall_index, double at_m, double width_m) const {
    const auto& wall = world_.walls[wall_index];
    if (at_m - 0.5 * width_m >= 0.0 && at_m + 0.5 * width_m <= wall.length()) return;
    s.fail("does not fit: wall " + wall.name + " is " + std::to_string(wall.length()) + " m long");
  }

  void readMaterial(Statement& s) {
    Material read;
    const auto name = s.word(0, "the name");
    const auto index = material(name);
    if (index < world_.materials.size()) read = world_.materials[index];
    read.name = name;
    std::vector<std::string> patterns;
    std::string pattern;
    for (const auto& [text, value] : kPatterns) {
      patterns.push_back(text);
      if (value == read.pattern) pattern = text;
    }
    s.choice("pattern", pattern, patterns, "how it is painted");
    for (const auto& [text, value] : kPatterns) {
      if (text == pattern) read.pattern = value;
    }
    s.triple("colour", read.colour, {0, 255});
    s.triple("second", read.second, {0, 255});
    s.number("grain", read.grain, {0, 100}, "gray levels of fine noise");
    s.number("blotches", read.blotches, {0, 100}, "gray levels of coarse noise");
    s.number("tile_m", read.tile_m, {0.02, 10}, "edge of a tile");
    s.finish(1);
    if (index < world_.materials.size()) {
      world_.materials[index] = read;
    } else {
      world_.materials.push_back(read);
    }
  }

  void wallOptions(Statement& s, Wall& wall) {
    s.number("height_m", wall.height_m, {0.1, 20}, "");
    s.number("skirting_m", wall.skirting_m, {0, 1}, "");
    s.integer("hallway", wall.hallway, {-1, 1000}, "");
    wall.material = material(s, "material", "plaster");
    wall.skirting_material = material(s, "skirting", "skirting");
  }

  void addWall(Statement& s, const Wall& wall) {
    if (wall.length() < 0.01) s.fail("wall " + wall.name + " is shorter than 1 cm");
    for (const auto& other : world_.walls) {
      if (other.name == wall.name) s.fail("there is a wall named " + wall.name + " already");
    }
    world_.walls.push_back(wall);
  }

  void readWall(Statement& s) {
    Wall read;
    read.name = s.word(0, "the name");
    read.a = s.point(1, "the start");
    read.b = s.point(3, "the end");
    wallOptions(s, read);
    s.finish(5);
    addWall(s, read);
  }

  void readRoom(Statement& s) {
    Wall read;
    const auto name = s.word(0, "the name");
    const auto corners = (s.wordCount() - 1) / 2;
    if (corners < 3) s.fail("needs at least three corners");
    wallOptions(s, read);
    s.finish(1 + 2 * corners);
    for (std::size_t i = 0; i < corners; ++i) {
      read.name = name + "." + std::to_string(i + 1);
      read.a = s.point(1 + 2 * i, "a corner");
      read.b = s.point(1 + 2 * ((i + 1) % corners), "a corner");
      addWall(s, read);
    }
  }

  void readDoor(Statement& s) {
    Door read;
    read.wall = wall(s);
    s.number("at_m", read.at_m, {0, 1e4}, "");
    s.number("width_m", read.width_m, {0.2, 10}, "");
    s.number("height_m", read.height_m, {0.5, 10}, "");
    s.number("recess_m", read.recess_m, {0, 2}, "");
    s.number("frame_m", read.frame_m, {0, 0.5}, "");
    s.number("protrusion_m", read.protrusion_m, {0, 0.5}, "");
    read.material = material(s, "material", "wood");
    read.frame_material = material(s, "frame", "frame");
    s.finish(0);
    onWallAt(s, read.wall, read.at_m, read.width_m + 2.0 * read.frame_m);
    if (read.height_m + read.frame_m >= world_.walls[read.wall].height_m) {
      s.fail("is as high as its wall");
    }
    world_.doors.push_back(read);
  }

  void readPilaster(Statement& s) {
    Pilaster read;
    read.wall = wall(s);
    s.number("at_m", read.at_m, {0, 1e4}, "");
    s.number("width_m", read.width_m, {0.02, 10}, "");
    s.number("depth_m", read.depth_m, {0.005, 5}, "");
    read.material = material(s, "material", "concrete");
    s.finish(0);
    onWallAt(s, read.wall, read.at_m, read.width_m);
    world_.pilasters.push_back(read);
  }

  void readPillar(Statement& s) {
    Pillar read;
    read.centre = s.point(0, "the centre");
    s.pair("size_m", read.size, {0.02, 10});
    s.angle("turn_deg", read.turn, {-180, 180}, "");
    s.number("height_m", read.height_m, {0.1, 20}, "");
    read.material = material(s, "material", "concrete");
    s.finish(2);
    world_.pillars.push_back(read);
  }

  void readBoard(Statement& s) {
    Board read;
    read.wall = wall(s);
    s.number("at_m", read.at_m, {0, 1e4}, "");
    s.number("width_m", read.width_m, {0.05, 20}, "");
    s.number("bottom_m", read.bottom_m, {0.02, 10}, "");
    s.number("height_m", read.height_m, {0.05, 10}, "");
    s.number("thickness_m", read.thickness_m, {0.002, 0.5}, "");
    read.material = material(s, "material", "cork");
    s.finish(0);
    onWallAt(s, read.wall, read.at_m, read.width_m);
    world_.boards.push_back(read);
  }

  void readLamp(Statement& s) {
    Lamp read;
    read.centre = s.point(0, "the centre");
    s.pair("size_m", read.size, {0.02, 10});
    s.number("brightness", read.brightness, {0, 10}, "");
    s.finish(2);
    world_.lamps.push_back(read);
  }

  void readFloor(Statement& s) {
    world_.floor_material = material(s, "material", "tiles");
    s.finish(0);
  }

  void readCeiling(Statement& s) {
    world_.ceiling_material = material(s, "material", "ceiling");
    s.finish(0);
  }

  void readTexture(Statement& s) {
    s.number("texels_per_m", world_.texels_per_m, {20, 1000}, "");
    s.finish(0);
  }

  void readStart(Statement& s) {
    const auto p = s.point(0, "the position");
    world_.route.start = {p.x(), p.y(), 0.0};
    s.angle("heading_deg", world_.route.start.phi, {-180, 180}, "");
    s.finish(2);
  }

  void readDrive(Statement& s) {
    RouteStep read;
    read.to = s.point(0, "the goal");
    s.number("speed_m_per_s", read.speed_m_per_s, {0.01, 10}, "");
    s.number("radius_m", read.radius_m, {0, 100}, "");
    s.finish(2);
    world_.route.steps.push_back(read);
  }

  void readTurn(Statement& s) {
    RouteStep read;
    read.kind = RouteStep::Kind::kTurn;
    read.angle = radians(s.numberWord(0, "the angle in degrees"));
    s.angle("rate_deg_per_s", read.turn_rate, {1, 720}, "");
    s.finish(1);
    world_.route.steps.push_back(read);
  }

  void readWait(Statement& s) {
    RouteStep read;
    read.kind = RouteStep::Kind::kWait;
    read.duration_s = s.numberWord(0, "the seconds");
    if (read.duration_s < 0.0 || read.duration_s > 3600.0) s.fail("waits 0 to 3600 s");
    s.finish(1);
    world_.route.steps.push_back(read);
  }

  void readCamera(Statement& s) {
    world_.camera.visit(s);
    if (world_.camera.supersampling % 2 == 0) s.fail("supersampling must be odd");
    s.finish(0);
  }
  void readDepth(Statement& s) { world_.depth.visit(s), s.finish(0); }
  void readColour(Statement& s) { world_.colour.visit(s), s.finish(0); }
  void readOdometry(Statement& s) { world_.odometry.visit(s), s.finish(0); }

  const std::map<std::string, Handler> handlers_ = {
      {"material", &WorldReader::readMaterial}, {"wall", &WorldReader::readWall},
      {"room", &WorldReader::readRoom},         {"door", &WorldReader::readDoor},
      {"pilaster", &WorldReader::readPilaster}, {"pillar", &WorldReader::readPillar},
      {"board", &WorldReader::readBoard},       {"lamp", &WorldReader::readLamp},
      {"floor", &WorldReader::readFloor},       {"ceiling", &WorldReader::readCeiling},
      {"texture", &WorldReader::readTexture},   {"start", &WorldReader::readStart},
      {"drive", &WorldReader::readDrive},       {"turn", &WorldReader::readTurn},
      {"wait", &WorldReader::readWait},         {"camera", &WorldReader::readCamera},
      {"depth", &WorldReader::readDepth},       {"colour", &WorldReader::readColour},
      {"odometry", &WorldReader::readOdometry}};

  std::string name_;
  World world_;
};

}  // namespace

World readWorld(const std::filesystem::path& path, const std::vector<std::string>& amendments) {
  std::ifstream file(path);
  if (!file) throw Error(path.string() + ": cannot be opened", ExitCode::kUsage);
  WorldReader reader(path.string());
  reader.read(file);
  for (const auto& line : amendments) reader.readLine(line, "'" + line + "'");
  return reader.finished();
}

World parseWorld(std::string_view text, const std::string& name) {
  std::istringstream input{std::string(text)};
  WorldReader reader(name);
  reader.read(input);
  return reader.finished();
}

}  // namespace colonnade
