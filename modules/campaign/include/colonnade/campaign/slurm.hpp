// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "colonnade/campaign/plan.hpp"

namespace colonnade {

struct SlurmOptions {
  std::filesystem::path program;        ///< as the nodes find it
  std::filesystem::path campaign_file;  ///< as the nodes find it
  std::string name = "campaign";        ///< of the jobs
  std::vector<std::string> directives;  ///< further #SBATCH lines, such as --partition=long
  std::vector<std::string> arguments;   ///< further arguments of `colonnade campaign`
  std::size_t most_tasks = 1000;        ///< Slurm's MaxArraySize is 1001 unless configured
};

/// Writes DIR/campaign.sbatch (a job array over the drives, several per task where there are more
/// than `most_tasks`), DIR/collect.sbatch (the table) and DIR/submit.sh, which submits both, the
/// second after the first. The folder must be the same path on all nodes. Returns submit.sh.
std::filesystem::path writeSlurmScripts(const CampaignPlan& plan, const SlurmOptions& options);

}  // namespace colonnade
