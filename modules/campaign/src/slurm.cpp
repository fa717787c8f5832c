// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/slurm.hpp"

#include "colonnade/base/atomic_file.hpp"
#include "shell_text.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

std::string directive(const std::string& text) { return "#SBATCH " + text + "\n"; }

}  // namespace

fs::path writeSlurmScripts(const CampaignPlan& plan, const SlurmOptions& options) {
  const fs::path folder = fs::absolute(plan.folder);
  const fs::path said = folder / "slurm";
  fs::create_directories(said);
  const std::size_t drives = plan.drives.size();
  const std::size_t per_task = (drives + options.most_tasks - 1) / options.most_tasks;
  const std::size_t tasks = (drives + per_task - 1) / per_task;
  std::vector<std::string> words{fs::absolute(options.program), "campaign",
                                 fs::absolute(options.campaign_file), "-o", folder};
  std::string further;
  for (const std::string& text : options.directives) further += directive(text);

  std::string arguments;
  for (const std::string& argument : options.arguments) arguments += " " + shellWord(argument);
  const std::string last = std::to_string(drives - 1);
  writeFileAtomically(folder / "campaign.sbatch",
                      "#!/bin/bash\n# One task per " + std::to_string(per_task) + " drive(s), " +
                          std::to_string(drives) + " in all.\n" +
                          directive("--job-name=" + shellWord(options.name)) +
                          directive("--array=0-" + std::to_string(tasks - 1)) +
                          directive("--ntasks=1") +
                          directive("--output=" + (said / "task-%a.txt").string()) + further +
                          "first=$((SLURM_ARRAY_TASK_ID * " + std::to_string(per_task) + "))\n" +
                          "last=$((first + " + std::to_string(per_task - 1) + "))\n" +
                          "if [ $last -gt " + last + " ]; then last=" + last + "; fi\n" + "exec " +
                          shellLine(words) + " --only $first..$last" + arguments + "\n");
  words.push_back("--collect");
  writeFileAtomically(
      folder / "collect.sbatch",
      "#!/bin/bash\n" + directive("--job-name=" + shellWord(options.name + "-table")) +
          directive("--ntasks=1") + directive("--output=" + (said / "collect.txt").string()) +
          further + "exec " + shellLine(words) + "\n");
  const fs::path submit = folder / "submit.sh";
  writeFileAtomically(
      submit,
      "#!/bin/bash\n# Submits the campaign; the table follows when all its tasks have ended. "
      "Prints both job numbers.\nset -euo pipefail\njob=$(sbatch --parsable " +
          shellWord(folder / "campaign.sbatch") + ")\necho \"${job%%;*}\"\n" +
          "sbatch --parsable --dependency=afterany:\"${job%%;*}\" " +
          shellWord(folder / "collect.sbatch") + "\n");
  fs::permissions(submit, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add);
  return submit;
}

}  // namespace colonnade
