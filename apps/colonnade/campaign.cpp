// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "colonnade/campaign/drive_runner.hpp"
#include "colonnade/campaign/slurm.hpp"
#include "colonnade/campaign/table.hpp"
#include "colonnade/jobs/job_runner.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

struct CampaignArguments {
  fs::path file;
  fs::path output;
  int parallel = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string only;
  bool collect = false;
  bool slurm = false;
  std::vector<std::string> directives;
  ResumeOptions resume;

  std::vector<std::string> flags() const {
    std::vector<std::string> words;
    if (resume.redo_changed) words.push_back("--redo");
    if (resume.retry_failed) words.push_back("--retry-failed");
    if (resume.keep_logs) words.push_back("--keep-logs");
    return words;
  }
};

/// Copies of the files of the campaign; their presence marks a campaign's folder.
fs::path sourceOf(const CampaignPlan& plan) { return plan.folder / "source"; }

void refuseForeignFolder(const CampaignPlan& plan) {
  if (fs::exists(plan.folder) && !fs::exists(sourceOf(plan) / "campaign.txt") &&
      (!fs::is_directory(plan.folder) || !fs::is_empty(plan.folder)))
    throw Error(plan.folder.string() +
                    ": exists and is neither empty nor a campaign's folder; give -o a new one",
                ExitCode::kUsage);
}

/// Takes the folder for this plan unless a run in it was made in another way.
fs::path claimFolder(const CampaignPlan& plan, const ResumeOptions& resume) {
  refuseForeignFolder(plan);
  for (const PlannedDrive& drive : plan.drives) pendingRuns(drive, resume);
  return freezeCampaign(plan.campaign, sourceOf(plan));
}

/// Writes and prints the table; anything failed or missing makes the exit code 1.
ExitCode collect(const CampaignPlan& plan) {
  const CampaignTable table = tabulate(plan);
  writeTable(table, plan);
  std::printf("%s", toMarkdown(table, plan).c_str());
  const auto missing = static_cast<std::size_t>(std::count_if(
      table.runs.begin(), table.runs.end(), [](const auto& run) { return !run.second; }));
  if (missing + table.failures() == 0) return ExitCode::kDone;
  throw Error(std::to_string(table.failures()) + " of " + std::to_string(plan.runs()) +
              " runs failed, " + std::to_string(missing) + " are missing; see " +
              (plan.folder / "campaign.md").string());
}

/// "3" or "0..9" as indices of drives.
std::vector<std::size_t> drivesOf(const std::string& only, std::size_t drives) {
  std::size_t bounds[2] = {0, 0};
  const auto dots = only.find("..");
  const std::string words[2] = {only.substr(0, dots),
                                dots == std::string::npos ? only : only.substr(dots + 2)};
  for (int i = 0; i < 2; ++i) {
    const char* end = words[i].data() + words[i].size();
    const auto read = std::from_chars(words[i].data(), end, bounds[i]);
    if (read.ec != std::errc() || read.ptr != end || bounds[i] >= drives || bounds[1 - i] >= drives)
      throw Error("--only " + only + ": give a drive, or a range such as 0..9, from 0 to " +
                      std::to_string(drives - 1),
                  ExitCode::kUsage);
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = bounds[0]; i <= bounds[1]; ++i) indices.push_back(i);
  return indices;
}

/// Runs drives in this process's own children, one after the other.
ExitCode runOnly(const CampaignPlan& plan, const CampaignArguments& arguments) {
  std::size_t failed = 0;
  for (const std::size_t index : drivesOf(arguments.only, plan.drives.size())) {
    const PlannedDrive& drive = plan.drives[index];
    const auto tell = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
    if (!runDrive(drive, plan.campaign, arguments.resume, tell)) return ExitCode::kInterrupted;
    for (const PlannedRun& run : drive.runs) failed += readRunRecord(run)->failed() ? 1 : 0;
  }
  if (failed == 0) return ExitCode::kDone;
  throw Error(std::to_string(failed) + " runs failed");
}

/// Says what became of the runs of a drive, and how long the rest will take.
class Reporter {
 public:
  Reporter(const CampaignPlan& plan, std::vector<std::size_t> drives, std::vector<Job> jobs)
      : plan_(plan), drives_(std::move(drives)), jobs_(std::move(jobs)) {}

  void operator()(const JobEvent& event) const {
    if (event.kind != JobEvent::Kind::kEnded) return;
    const PlannedDrive& drive = plan_.drives[drives_[event.index]];
    std::size_t failed = 0;
    bool all = true;
    for (const PlannedRun& run : drive.runs) {
      const auto record = readRunRecord(run);
      all = all && record;
      if (!record || !record->failed()) continue;
      ++failed;
      std::fprintf(stderr, "%s: failed: %s\n", run.name().c_str(), record->failure.c_str());
    }
    if (!all && event.result->status != JobResult::Status::kInterrupted)
      std::fprintf(stderr, "%s: %s: %s\n", drive.name().c_str(), event.result->text().c_str(),
                   lastLineOf(jobs_[event.index].log).c_str());
    const double elapsed =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const auto left = static_cast<double>(event.total - event.ended);
    const int eta = static_cast<int>(elapsed * left / static_cast<double>(event.ended));
    std::fprintf(stderr, "%zu of %zu drives  %s: %s  ETA %d:%02d\n", event.ended, event.total,
                 drive.name().c_str(),
                 !all         ? "not complete"
                 : failed > 0 ? (std::to_string(failed) + " failed").c_str()
                              : "done",
                 eta / 60, eta % 60);
  }

 private:
  const CampaignPlan& plan_;
  std::vector<std::size_t> drives_;
  std::vector<Job> jobs_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ExitCode runAll(const CampaignPlan& plan, const CampaignArguments& arguments) {
  const fs::path file = claimFolder(plan, arguments.resume);
  std::vector<std::size_t> drives;
  std::vector<Job> jobs;
  std::size_t runs = 0;
  for (const PlannedDrive& drive : plan.drives) {
    const auto pending = pendingRuns(drive, arguments.resume);
    runs += pending.size();
    if (pending.empty()) continue;
    Job job;
    job.name = drive.name();
    job.arguments = {"campaign",       arguments.file, "-o",
                     arguments.output, "--only",       std::to_string(drive.index)};
    for (const std::string& flag : arguments.flags()) job.arguments.push_back(flag);
    job.log = drive.folder / "drive.txt";
    drives.push_back(drive.index);
    jobs.push_back(std::move(job));
  }
  std::fprintf(stderr, "%zu of %zu runs to do, in %zu drives, %d at a time\n", runs, plan.runs(),
               jobs.size(), arguments.parallel);
  JobRunner runner({.parallel = arguments.parallel});
  runner.run(jobs, Reporter(plan, drives, jobs));
  if (runner.interrupted()) {
    std::fprintf(stderr, "interrupted; the same command goes on where it stopped\n");
    return ExitCode::kInterrupted;
  }
  return collect(plan);
}

ExitCode campaign(const CampaignArguments& arguments) {
  const CampaignPlan plan =
      planCampaign(readCampaign(arguments.file), arguments.output, digestOfFile("/proc/self/exe"));
  if (!arguments.only.empty()) return runOnly(plan, arguments);
  if (arguments.collect) {
    if (!fs::exists(sourceOf(plan) / "campaign.txt"))
      throw Error(plan.folder.string() + ": no campaign has run there", ExitCode::kUsage);
    return collect(plan);
  }
  if (!arguments.slurm) return runAll(plan, arguments);
  SlurmOptions options;
  options.program = thisProgram();
  options.campaign_file = claimFolder(plan, arguments.resume);
  options.name = arguments.file.stem().string();
  options.directives = arguments.directives;
  options.arguments = arguments.flags();
  std::printf("%zu drives, %zu runs; submit them with\n  %s\n", plan.drives.size(), plan.runs(),
              writeSlurmScripts(plan, options).c_str());
  return ExitCode::kDone;
}

}  // namespace

Action addCampaign(CLI::App& verb) {
  const auto arguments = std::make_shared<CampaignArguments>();
  verb.description(
      "Many simulated worlds, seeds and configurations in parallel processes, and one table. What "
      "is done is never repeated: the same command goes on where it stopped");
  verb.add_option("FILE", arguments->file, "campaign file, see rawlogs/campaigns")->required();
  verb.add_option("-o,--output", arguments->output, "folder of the campaign, new or to go on with")
      ->required();
  verb.add_option("--jobs", arguments->parallel, "drives (a world with a seed) at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  verb.add_flag("--keep-logs", arguments->resume.keep_logs,
                "keep simulated logs; default: deleted when all their runs are done");
  verb.add_flag("--redo", arguments->resume.redo_changed,
                "repeat runs made with another program, world or options");
  verb.add_flag("--retry-failed", arguments->resume.retry_failed, "repeat runs that failed");
  auto* only = verb.add_option("--only", arguments->only,
                               "only this drive, or a range such as 0..9, and no table");
  auto* collect =
      verb.add_flag("--collect", arguments->collect, "run nothing; make the table of what is done");
  auto* slurm = verb.add_flag("--slurm", arguments->slurm,
                              "run nothing; write a Slurm job array that does it");
  verb.add_option("--sbatch", arguments->directives,
                  "a further #SBATCH line, such as --sbatch=--partition=long")
      ->allow_extra_args(false)
      ->needs(slurm);
  only->excludes(collect)->excludes(slurm);
  collect->excludes(slurm);
  verb.footer(
      "Examples:\n"
      "  colonnade campaign rawlogs/campaigns/ring.campaign -o ring --jobs 4\n"
      "  colonnade campaign ring.campaign -o ring --collect\n"
      "  colonnade campaign ring.campaign -o /shared/ring --slurm --sbatch=--time=2:00:00\n"
      "  /shared/ring/submit.sh");
  return [arguments] { return campaign(*arguments); };
}

}  // namespace colonnade
