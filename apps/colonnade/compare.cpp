// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/jobs/job_runner.hpp"
#include "compare_table.hpp"
#include "results_folder.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path log;
  fs::path config;
  fs::path output;
  fs::path ground_truth;
  int runs = 7;
  int jobs = 1;
  double timeout_s = 3600.0;
  bool ablations = false;
  std::string backend = kDefaultBackend;
};

/// One run of one method.
struct PlannedRun {
  std::size_t method;
  fs::path folder;
  Job job;
};

std::vector<PlannedRun> plan(const std::vector<ComparedMethod>& methods, const Arguments& arguments,
                             const fs::path& folder) {
  std::vector<PlannedRun> runs;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (!methods[m].missing.empty()) continue;
    for (int i = 1; i <= methods[m].runs; ++i) {
      const std::string name =
          methods[m].key + (methods[m].runs > 1 ? "-" + std::to_string(i) : "");
      PlannedRun run{m, folder / "runs" / name, {}};
      run.job.name = name;
      run.job.arguments = methods[m].arguments;
      const auto add = [&](const std::string& option, const fs::path& value) {
        run.job.arguments.push_back(option);
        run.job.arguments.push_back(value.string());
      };
      run.job.arguments.push_back(arguments.log.string());
      add("-o", run.folder);
      if (!arguments.ground_truth.empty()) add("--ground-truth", arguments.ground_truth);
      if (!arguments.config.empty()) add("-c", arguments.config);
      if (i > 1) run.job.arguments.push_back("--no-map-files");  // one of each is enough
      run.job.log = folder / "logs" / (name + ".txt");
      run.job.timeout_s = arguments.timeout_s;
      runs.push_back(run);
    }
  }
  return runs;
}

ExitCode compare(const Arguments& arguments) {
  if (!arguments.ground_truth.empty() && readTum(arguments.ground_truth).empty())
    throw Error(arguments.ground_truth.string() + ": holds no pose");
  ComparisonNotes notes;
  notes.log = arguments.log.string();
  notes.contents = contentsOf(arguments.log, arguments.config);
  notes.contents.truth = !arguments.ground_truth.empty();
  notes.jobs = arguments.jobs;
  notes.random_runs = arguments.runs;
  const auto methods =
      comparedMethods(notes.contents, arguments.runs, arguments.ablations, arguments.backend);
  const fs::path folder = makeResultsFolder(arguments.output, arguments.log);
  fs::create_directories(folder / "runs");
  fs::create_directories(folder / "logs");

  const std::vector<PlannedRun> runs = plan(methods, arguments, folder);
  std::vector<Job> jobs;
  for (const PlannedRun& run : runs) jobs.push_back(run.job);
  JobRunner runner({arguments.jobs});
  const auto results = runner.run(jobs, [&](const JobEvent& event) {
    if (event.kind != JobEvent::Kind::kEnded) return;
    std::fprintf(stderr, "%zu of %zu  %s: %s, %s s\n", event.ended, event.total,
                 jobs[event.index].name.c_str(), event.result->text().c_str(),
                 formatFixed(event.result->wall_s, 1).c_str());
  });

  std::vector<MethodOutcome> outcomes;
  for (const ComparedMethod& method : methods) outcomes.push_back({method, {}});
  bool lossy = false;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    outcomes[runs[i].method].runs.push_back(outcomeOf(results[i], runs[i].folder, runs[i].job.log));
    lossy |= results[i].status == JobResult::Status::kExited &&
             results[i].exit_code == static_cast<int>(ExitCode::kLossy);
  }
  const std::string table = toMarkdown(outcomes, notes);
  writeFileAtomically(folder / "compare.md", table);
  writeFileAtomically(
      folder / "compare.json",
      toJson(outcomes, notes).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  std::printf("%s\nresults    %s\n", table.c_str(), folder.c_str());
  if (runner.interrupted()) return ExitCode::kInterrupted;
  const bool any_passed = std::any_of(
      outcomes.begin(), outcomes.end(),
      [](const MethodOutcome& outcome) { return outcome.failures() < outcome.runs.size(); });
  if (!any_passed) return ExitCode::kFailed;
  return lossy ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace

Action addCompare(CLI::App& verb) {
  const auto arguments = std::make_shared<Arguments>();
  verb.add_option("LOG", arguments->log, "rawlog, plain or gz")->required();
  verb.add_option("-c,--config", arguments->config, "INI file for every run");
  verb.add_option("-o,--output", arguments->output, "new folder; default: LOG's stem + _results");
  verb.add_option("--ground-truth", arguments->ground_truth,
                  "robot poses, TUM file: without it there are times and sizes, but no errors");
  verb.add_option("--runs", arguments->runs, "of methods that draw random numbers")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--jobs", arguments->jobs, "runs at a time; more than one disturbs the times")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  verb.add_option("--timeout", arguments->timeout_s, "seconds a run may take")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  verb.add_flag("--ablations", arguments->ablations,
                "also Colonnade without one part each, and with each edge backend");
  verb.add_option("--backend", arguments->backend,
                  "image stage of Colonnade's runs: fixed, opencv, rtl")
      ->capture_default_str();
  verb.footer(
      "Examples:\n"
      "  colonnade compare corridor.rawlog -o comparison --ground-truth "
      "corridor_ground_truth.tum\n"
      "  colonnade compare corridor.rawlog --ablations --runs 15 --jobs 4");
  return [arguments] { return compare(*arguments); };
}

}  // namespace colonnade
