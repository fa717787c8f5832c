// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "world_statements.hpp"

namespace colonnade {
namespace {

const std::map<std::string, void (*)(Statement&, World&)> kBuildingStatements = {
    {"material", readMaterial}, {"wall", readWall},       {"room", readRoom},
    {"door", readDoor},         {"board", readBoard},     {"pilaster", readPilaster},
    {"pillar", readPillar},     {"column", readColumn},   {"table", readTable},
    {"chair", readChair},       {"cabinet", readCabinet}, {"bin", readBin},
    {"lamp", readLamp},         {"walker", readWalker},   {"floor", readFloor},
    {"ceiling", readCeiling},   {"texture", readTexture}};

const std::map<std::string, void (*)(Statement&, World&)> kRobotStatements = {
    {"robot", readRobot}, {"start", readStart},   {"drive", readDrive},
    {"turn", readTurn},   {"wait", readWait},     {"camera", readCamera},
    {"depth", readDepth}, {"colour", readColour}, {"odometry", readOdometry},
    {"light", readLight}, {"mono", readMono}};

/// A part of the route, from `repeat` to `end`, that is driven several times.
struct Repetition {
  std::size_t begin = 0;
  std::size_t end = 0;
  int times = 1;
  std::string where;
  bool closed = false;
};

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
    if (statement.keyword() == "repeat") return beginRepetition(statement);
    if (statement.keyword() == "end") return endRepetition(statement);
    if (statement.keyword() == "route") return readRouteOptions(statement);
    for (const auto* statements : {&kBuildingStatements, &kRobotStatements}) {
      const auto found = statements->find(statement.keyword());
      if (found != statements->end()) return found->second(statement, world_);
    }
    std::vector<std::string> known = {"repeat", "end", "route"};
    for (const auto* statements : {&kBuildingStatements, &kRobotStatements}) {
      for (const auto& [keyword, handler] : *statements) known.push_back(keyword);
    }
    throw Error(
        where + ": unknown keyword '" + statement.keyword() + "'; known: " + joined(known, ", "),
        ExitCode::kUsage);
  }

  World finished() {
    if (world_.walls.empty()) throw Error(name_ + ": has no wall; add one", ExitCode::kUsage);
    if (world_.route.steps.empty()) {
      throw Error(name_ + ": the robot has no route; add 'drive X Y'", ExitCode::kUsage);
    }
    writeOutRepetitions();
    if (world_.route.where.empty()) world_.route.where = name_;
    return std::move(world_);
  }

 private:
  void beginRepetition(Statement& s) {
    if (!repetitions_.empty() && !repetitions_.back().closed) {
      s.fail("inside the repeat of " + repetitions_.back().where + "; write 'end' before it");
    }
    Repetition read;
    const double times = s.numberWord(0, "how often");
    if (times != std::round(times) || times < 1.0 || times > 1000.0) {
      s.fail("repeats 1 to 1000 times, a whole number");
    }
    s.finish(1);
    read.begin = world_.route.steps.size();
    read.times = static_cast<int>(times);
    read.where = s.where();
    repetitions_.push_back(read);
  }

  void endRepetition(Statement& s) {
    s.finish(0);
    if (repetitions_.empty() || repetitions_.back().closed) {
      s.fail("there is no repeat that it could end; write 'repeat N' above");
    }
    repetitions_.back().end = world_.route.steps.size();
    repetitions_.back().closed = true;
  }

  void readRouteOptions(Statement& s) {
    s.integer("laps", laps_, {1, 1000}, "");
    s.finish(0);
  }

  void writeOutRepetitions() {
    std::vector<RouteStep> steps;
    const auto& written = world_.route.steps;
    const auto append = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) steps.push_back(written[i]);
    };
    std::size_t done = 0;
    for (const auto& part : repetitions_) {
      if (!part.closed) {
        throw Error(part.where + ": repeat has no 'end'; write it below its last drive",
                    ExitCode::kUsage);
      }
      append(done, part.begin);
      for (int i = 0; i < (laps_ > 0 ? laps_ : part.times); ++i) append(part.begin, part.end);
      done = part.end;
    }
    append(done, written.size());
    world_.route.steps = std::move(steps);
  }

  std::string name_;
  World world_;
  std::vector<Repetition> repetitions_;
  int laps_ = 0;  ///< instead of every repetition's own number, 0 = none
};

}  // namespace

World parseWorld(std::string_view text, const std::string& name,
                 const std::vector<std::string>& amendments) {
  std::istringstream input{std::string(text)};
  WorldReader reader(name);
  reader.read(input);
  for (const auto& line : amendments) reader.readLine(line, "'" + line + "'");
  return reader.finished();
}

}  // namespace colonnade
