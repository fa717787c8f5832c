// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/plan.hpp"

#include <array>
#include <cstdint>
#include <fstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

std::string hexadecimal(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

std::string seedFolder(std::uint64_t seed) { return "seed-" + std::to_string(seed); }

/// --set for each, in a row of arguments.
void addSettings(std::vector<std::string>& arguments, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
}

std::string digestOfSource(const std::string& source) {
  return source.starts_with("random:") ? source : digestOfFile(source);
}

PlannedRun planRun(const PlannedDrive& drive, const CampaignConfiguration& configuration,
                   std::size_t index, const std::filesystem::path& folder) {
  PlannedRun run;
  run.index = index;
  run.world = drive.world;
  run.seed = drive.seed;
  run.configuration = configuration.name;
  run.folder = folder / "runs" / drive.world / seedFolder(drive.seed) / configuration.name;
  std::vector<std::string> options;
  if (!configuration.backend.empty()) options = {"--backend", configuration.backend};
  addSettings(options, configuration.assignments);
  run.stamp = drive.stamp + "run: " + joined(options, " ") + "\nconfiguration: " +
              (configuration.file.empty() ? "built in" : digestOfFile(configuration.file)) + "\n";
  const std::string truth = drive.truth().string();
  run.run_arguments = {"run", drive.log().string(), "-o", run.results().string(), "--ground-truth",
                       truth};
  if (!configuration.file.empty())
    run.run_arguments.insert(run.run_arguments.end(), {"-c", configuration.file.string()});
  run.run_arguments.insert(run.run_arguments.end(), options.begin(), options.end());
  run.evaluate_arguments = {"evaluate", run.results().string(), "--ground-truth", truth, "--json"};
  return run;
}

}  // namespace

std::string PlannedDrive::name() const { return world + " seed " + std::to_string(seed); }
std::string PlannedRun::name() const {
  return world + " seed " + std::to_string(seed) + " " + configuration;
}

std::size_t CampaignPlan::runs() const { return drives.size() * campaign.configurations.size(); }

CampaignPlan planCampaign(const Campaign& campaign, const std::filesystem::path& folder,
                          const std::string& program_digest) {
  CampaignPlan plan{campaign, folder, {}};
  std::size_t run_index = 0;
  for (const CampaignWorld& world : campaign.worlds) {
    std::vector<std::string> options;
    addSettings(options, world.amendments);
    const std::string digest = digestOfSource(world.source);
    for (const std::uint64_t seed : campaign.seeds) {
      PlannedDrive drive;
      drive.index = plan.drives.size();
      drive.world = world.name;
      drive.seed = seed;
      drive.folder = folder / "logs" / world.name / seedFolder(seed);
      drive.stamp = "program: " + program_digest + "\nworld: " + digest + "\nsimulate: --seed " +
                    std::to_string(seed) + (options.empty() ? "" : " " + joined(options, " ")) +
                    "\n";
      drive.simulate_arguments = {"simulate",           world.source, "-o",
                                  drive.log().string(), "--seed",     std::to_string(seed),
                                  "--overwrite"};
      drive.simulate_arguments.insert(drive.simulate_arguments.end(), options.begin(),
                                      options.end());
      for (const CampaignConfiguration& configuration : campaign.configurations)
        drive.runs.push_back(planRun(drive, configuration, run_index++, folder));
      plan.drives.push_back(std::move(drive));
    }
  }
  return plan;
}

std::string digestOfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error(path.string() + ": cannot be read", ExitCode::kUsage);
  std::uint64_t hash = 0xcbf29ce484222325U;
  std::array<char, 65536> block{};
  while (file.read(block.data(), block.size()), file.gcount() > 0) {
    for (std::streamsize i = 0; i < file.gcount(); ++i) {
      hash ^= static_cast<unsigned char>(block[static_cast<std::size_t>(i)]);
      hash *= 0x100000001b3U;
    }
  }
  return hexadecimal(hash);
}

}  // namespace colonnade
