// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "colonnade/campaign/campaign_file.hpp"

namespace colonnade {

/// One configuration on one log.
struct PlannedRun {
  std::size_t index = 0;  ///< in the campaign: worlds, then seeds, then configurations
  std::string world;
  std::uint64_t seed = 0;
  std::string configuration;
  std::filesystem::path folder;                 ///< DIR/runs/WORLD/seed-N/CONFIGURATION
  std::vector<std::string> run_arguments;       ///< of the program
  std::vector<std::string> evaluate_arguments;  ///< of the program
  /// What its numbers depend on, a line each ("world: 0123456789abcdef"): program, world, options
  /// of simulate, options of run, configuration file. Where the folder lies is no part of it.
  std::string stamp;

  std::filesystem::path results() const { return folder / "results"; }
  std::string name() const;  ///< "ring seed 4 default"
};

/// One world with one seed: a log and all its runs. The unit of parallel work and of a Slurm task,
/// so that no two processes share a log.
struct PlannedDrive {
  std::size_t index = 0;
  std::string world;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< DIR/logs/WORLD/seed-N
  std::vector<std::string> simulate_arguments;
  std::string stamp;
  std::vector<PlannedRun> runs;

  std::filesystem::path log() const { return folder / "log.rawlog"; }
  std::filesystem::path truth() const { return folder / "log_ground_truth.tum"; }
  std::string name() const;  ///< "ring seed 4"
};

struct CampaignPlan {
  Campaign campaign;
  std::filesystem::path folder;
  std::vector<PlannedDrive> drives;
  std::size_t runs() const;
};

/// Lays a campaign out in `folder`. `program_digest` stands for the program that will run. Throws
/// Error when a world or configuration file cannot be read.
CampaignPlan planCampaign(const Campaign& campaign, const std::filesystem::path& folder,
                          const std::string& program_digest);

/// 64 bits of FNV-1a (draft-eastlake-fnv) of a whole file as 16 hexadecimal digits: tells a changed
/// file from the former one, nothing more.
std::string digestOfFile(const std::filesystem::path& path);

}  // namespace colonnade
