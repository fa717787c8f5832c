// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/simulation/random_world.hpp"
#include "colonnade/simulation/world_check.hpp"

namespace colonnade {
namespace {

constexpr std::string_view kRandom = "random:";
constexpr double kLargestSeed = 9007199254740992.0;  ///< 2^53: every whole number up to it is exact

std::string randomText(const std::string& name) {
  const auto seed = parseDouble(name.substr(kRandom.size()));
  if (!seed || *seed < 0.0 || *seed != std::floor(*seed) || *seed > kLargestSeed) {
    throw Error(name + ": write random:SEED, the seed a whole number from 0, such as random:7",
                ExitCode::kUsage);
  }
  return randomWorldText(static_cast<std::uint64_t>(*seed));
}

std::string fileText(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file || std::filesystem::is_directory(name)) {
    throw Error(name + ": cannot be opened; give a world file or random:SEED", ExitCode::kUsage);
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

LoadedWorld loadWorld(const std::string& name, const std::vector<std::string>& amendments) {
  const bool random = name.rfind(kRandom, 0) == 0;
  LoadedWorld loaded;
  loaded.text = random ? randomText(name) : fileText(name);
  loaded.world = parseWorld(loaded.text, name, amendments);
  checkWorld(loaded.world);
  if (!amendments.empty()) {
    if (!loaded.text.empty() && loaded.text.back() != '\n') loaded.text += '\n';
    loaded.text += "\n# Set when this world was simulated.\n";
    for (const auto& line : amendments) loaded.text += line + "\n";
  }
  return loaded;
}

World readWorld(const std::filesystem::path& path, const std::vector<std::string>& amendments) {
  return loadWorld(path.string(), amendments).world;
}

}  // namespace colonnade
