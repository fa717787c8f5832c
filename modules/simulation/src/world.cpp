// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "world_statements.hpp"

namespace colonnade {
namespace {

const std::map<std::string, void (*)(Statement&, World&)> kStatements = {
    {"material", readMaterial}, {"wall", readWall},         {"room", readRoom},
    {"door", readDoor},         {"pilaster", readPilaster}, {"pillar", readPillar},
    {"board", readBoard},       {"lamp", readLamp},         {"walker", readWalker},
    {"floor", readFloor},       {"ceiling", readCeiling},   {"texture", readTexture},
    {"start", readStart},       {"drive", readDrive},       {"turn", readTurn},
    {"wait", readWait},         {"camera", readCamera},     {"depth", readDepth},
    {"colour", readColour},     {"odometry", readOdometry}};

/// Turns lines into a world.
class WorldReader {
 public:
  explicit WorldReader(std::string name) : name_(std::move(name)) {
    world_.name = std::filesystem::path(name_).stem().string();
    addBuiltInMaterials(world_);
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
    const auto found = kStatements.find(statement.keyword());
    if (found == kStatements.end()) {
      std::vector<std::string> known;
      for (const auto& [keyword, handler] : kStatements) known.push_back(keyword);
      throw Error(
          where + ": unknown keyword '" + statement.keyword() + "'; known: " + joined(known, ", "),
          ExitCode::kUsage);
    }
    found->second(statement, world_);
  }

  World finished() {
    if (world_.walls.empty()) throw Error(name_ + ": has no wall; add one", ExitCode::kUsage);
    if (world_.route.steps.empty()) {
      throw Error(name_ + ": the robot has no route; add 'drive X Y'", ExitCode::kUsage);
    }
    return std::move(world_);
  }

 private:
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
