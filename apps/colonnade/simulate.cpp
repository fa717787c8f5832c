// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/simulation/simulator.hpp"
#include "colonnade/simulation/world_file.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

struct SimulateArguments {
  std::string world;
  std::string log;
  std::vector<std::string> shorthands;  ///< section.key=value, from --width and the like
  std::vector<std::string> settings;    ///< --set section.key=value; they win
  bool overwrite = false;
  SimulationOptions options;
};

/// "camera.rate_hz=5" -> the statement "camera rate_hz=5".
std::string statementOf(const std::string& setting) {
  const auto dot = setting.find('.');
  if (dot == std::string::npos || setting.find('=', dot) == std::string::npos) {
    throw Error("--set " + setting + ": write it as section.key=value, such as camera.rate_hz=5",
                ExitCode::kUsage);
  }
  return setting.substr(0, dot) + " " + setting.substr(dot + 1);
}

bool holds(const std::filesystem::path& path, const std::string& text) {
  std::ifstream file(path, std::ios::binary);
  return std::equal(std::istreambuf_iterator<char>(file), {}, text.begin(), text.end());
}

/// Where the world is kept beside its log: STEM.world. Nowhere when the world is that very file and
/// nothing was set; never over it.
std::filesystem::path copyPath(const SimulateArguments& arguments, bool amended) {
  const std::string stem = logStem(arguments.log).string();
  const std::filesystem::path path = stem + ".world";
  std::error_code ignored;
  if (!std::filesystem::equivalent(path, arguments.world, ignored)) return path;
  return amended ? std::filesystem::path(stem + "_as_driven.world") : std::filesystem::path();
}

ExitCode simulateVerb(const SimulateArguments& arguments) {
  std::vector<std::string> amendments;
  for (const auto* settings : {&arguments.shorthands, &arguments.settings})
    for (const auto& setting : *settings) amendments.push_back(statementOf(setting));
  const auto loaded = loadWorld(arguments.world, amendments);
  const auto world_copy = copyPath(arguments, !amendments.empty());
  for (const std::filesystem::path& file : {std::filesystem::path(arguments.log), world_copy}) {
    if (!arguments.overwrite && std::filesystem::exists(file) && !holds(file, loaded.text)) {
      throw Error(file.string() + " exists; choose another name or add --overwrite",
                  ExitCode::kUsage);
    }
  }
  SimulationOptions options = arguments.options;
  Progress progress;
  const InterruptGuard interrupt;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (interrupt.requested())
      throw Error("interrupted after " + std::to_string(done) + " frames; nothing is written",
                  ExitCode::kInterrupted);
    progress.show(static_cast<double>(done) / static_cast<double>(total), done, "");
  };
  const auto summary = simulate(loaded.world, arguments.log, options);
  progress.finish();
  if (!world_copy.empty()) writeFileAtomically(world_copy, loaded.text);
  std::printf("%s: %zu frames, %s s, %s m, %s MB; %zu of %zu landmarks seen\n",
              arguments.log.c_str(), summary.frames, formatFixed(summary.duration_s, 1).c_str(),
              formatFixed(summary.path_length_m, 2).c_str(),
              formatFixed(static_cast<double>(summary.log_bytes) / 1e6, 2).c_str(),
              summary.landmarks_seen, summary.landmarks);
  return ExitCode::kDone;
}

}  // namespace

Action addSimulate(CLI::App& verb) {
  auto arguments = std::make_shared<SimulateArguments>();
  verb.description("Drive a robot through a simulated building: a rawlog with the truth beside it");
  verb.add_option("WORLD", arguments->world, "world file, see rawlogs/worlds, or random:SEED")
      ->required();
  verb.add_option("-o,--output", arguments->log, "rawlog to write")->required();
  verb.add_option("--seed", arguments->options.seed, "of all noise")
      ->check(notNegative())
      ->capture_default_str();
  const auto shorthand = [&](const char* name, const char* key, const char* meaning) {
    verb.add_option_function<std::string>(
        name,
        [arguments, key](const std::string& value) {
          arguments->shorthands.push_back(std::string(key) + "=" + value);
        },
        meaning);
  };
  shorthand("--width", "camera.width_px", "image width, pixels");
  shorthand("--height", "camera.height_px", "image height, pixels");
  shorthand("--rate", "camera.rate_hz", "frames per second");
  shorthand("--jpeg-quality", "camera.jpeg_quality", "of the colour images, 10 to 100");
  verb.add_option("--set", arguments->settings,
                  "section.key=value over the world file, such as odometry.scale=0")
      ->allow_extra_args(false);
  verb.add_option("--gz-level", arguments->options.gz_level, "0 plain, 1 fast ... 9 small")
      ->check(CLI::Range(0, 9))
      ->capture_default_str();
  verb.add_flag("--overwrite", arguments->overwrite, "replace an existing log");
  verb.footer(
      "Examples:\n"
      "  colonnade simulate rawlogs/worlds/corridor.world -o /tmp/corridor.rawlog --seed 7\n"
      "  colonnade simulate rawlogs/worlds/corridor.world -o big.rawlog --width 640 --height 480\n"
      "  colonnade simulate random:7 -o seven.rawlog     (its world: seven.world)\n"
      "  colonnade simulate rawlogs/worlds/corridor.world -o calm.rawlog --set odometry.scale=0");
  return [arguments] { return simulateVerb(*arguments); };
}

}  // namespace colonnade
