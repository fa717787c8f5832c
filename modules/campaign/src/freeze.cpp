// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <sstream>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/campaign/campaign_file.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || fs::is_directory(path))
    throw Error(path.string() + ": cannot be read", ExitCode::kUsage);
  text << file.rdbuf();
  return text.str();
}

void writeIfNew(const fs::path& path, const std::string& content) {
  if (!fs::exists(path) || contentOf(path) != content) writeFileAtomically(path, content);
}

std::string with(const std::vector<std::string>& settings) {
  return settings.empty() ? "" : " " + joined(settings, " ");
}

}  // namespace

fs::path freezeCampaign(const Campaign& campaign, const fs::path& folder) {
  fs::create_directories(folder);
  std::string text;
  for (const CampaignWorld& world : campaign.worlds) {
    std::string source = world.source;
    if (!source.starts_with("random:")) {
      source = world.name + ".world";
      writeIfNew(folder / source, contentOf(world.source));
    }
    text += "world " + world.name + " " + source + with(world.amendments) + "\n";
  }
  text += "seeds";
  for (const std::uint64_t seed : campaign.seeds) text += " " + std::to_string(seed);
  text += "\n";
  for (const CampaignConfiguration& configuration : campaign.configurations) {
    text += "configuration " + configuration.name;
    if (!configuration.backend.empty()) text += " backend=" + configuration.backend;
    if (!configuration.file.empty()) {
      writeIfNew(folder / (configuration.name + ".ini"), contentOf(configuration.file));
      text += " file=" + configuration.name + ".ini";
    }
    text += with(configuration.assignments) + "\n";
  }
  text += "failure ate_m=" + formatDouble(campaign.failure.max_ate_m) +
          " coverage=" + formatDouble(campaign.failure.min_coverage) + "\ntimeout_s " +
          formatDouble(campaign.timeout_s) + "\n";
  const fs::path copy = folder / "campaign.txt";
  writeIfNew(copy, text);
  return copy;
}

}  // namespace colonnade
