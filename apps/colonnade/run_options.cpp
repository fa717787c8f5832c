// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "run_options.hpp"

#include "colonnade/base/config.hpp"

namespace colonnade {

RunOptions readRunOptions(const std::filesystem::path& path,
                          const std::vector<std::string>& assignments) {
  Config config = path.empty() ? Config() : Config::fromFile(path);
  for (const std::string& assignment : assignments) config.set(assignment);
  RunOptions options;
  options.each([&](auto& section) { config.read(section); });
  config.requireAllKnown();
  return options;
}

std::string effectiveConfig(RunOptions options) {
  ConfigWriter writer;
  options.each([&](const auto& section) { writer.add(section); });
  return writer.text();
}

}  // namespace colonnade
