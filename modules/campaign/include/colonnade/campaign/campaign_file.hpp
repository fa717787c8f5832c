// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace colonnade {

/// A building with its robot and sensors, as `simulate` takes it.
struct CampaignWorld {
  std::string name;
  std::string source;                   ///< world file, or random:SEED
  std::vector<std::string> amendments;  ///< section.key=value, over the world file
};

/// One way to run the program on a log.
struct CampaignConfiguration {
  std::string name;
  std::string backend;                   ///< empty: the program's default
  std::filesystem::path file;            ///< INI; empty: none
  std::vector<std::string> assignments;  ///< Section.key=value
};

/// When a run that ended well still counts as failed.
struct FailureRule {
  double max_ate_m = 1.0;
  double min_coverage = 0.9;  ///< share of the truth's time span
};

/// Every world with every seed with every configuration.
struct Campaign {
  std::vector<CampaignWorld> worlds;
  std::vector<std::uint64_t> seeds;
  std::vector<CampaignConfiguration> configurations;
  FailureRule failure;
  double timeout_s = 3600.0;  ///< of each process
};

/// Reads a campaign file; the format is described in modules/campaign/README.md. Paths in it are
/// relative to the file. Throws Error (kUsage) as "file:line: what is wrong".
Campaign readCampaign(const std::filesystem::path& path);

/// The same from text; `path` stands for the file in errors and relative paths.
Campaign parseCampaign(std::string_view text, const std::filesystem::path& path);

/// Copies every file the campaign names, and the campaign itself as campaign.txt, into `folder`, so
/// that an edit meanwhile does not change a campaign half-way. Returns the copy, which names the
/// copies. Files that are the same already are not touched.
std::filesystem::path freezeCampaign(const Campaign& campaign, const std::filesystem::path& folder);

}  // namespace colonnade
