// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/drive_runner.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/jobs/job_runner.hpp"
#include "folder_lock.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

/// Thrown through a drive when the user stops it.
struct Interrupted {};

JobResult process(const std::string& name, const std::vector<std::string>& arguments,
                  const fs::path& log, const fs::path& output, double timeout_s) {
  Job job;
  job.name = name;
  job.arguments = arguments;
  job.log = log;
  job.output = output;
  job.timeout_s = timeout_s;
  JobRunner runner;
  const JobResult result = runner.run({job}).front();
  if (runner.interrupted()) throw Interrupted();
  return result;
}

/// "run: exit 2: what it said last".
std::string complaint(const std::string& verb, const JobResult& result, const fs::path& log) {
  const std::string said = lastLineOf(log);
  return verb + ": " + result.text() + (said.empty() ? "" : ": " + said);
}

int codeOf(const JobResult& result) {
  return result.status == JobResult::Status::kExited ? result.exit_code : 128 + result.signal;
}

std::string contentOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The log of a drive: made once, used by all its runs. log.stamp says that it is whole.
class DriveLog {
 public:
  explicit DriveLog(const PlannedDrive& drive)
      : drive_(drive), stamp_(drive.folder / "log.stamp") {}

  bool ready() const { return fs::exists(drive_.log()) && contentOf(stamp_) == drive_.stamp; }
  JobResult make(double timeout_s) const {
    fs::remove(stamp_);
    removeUnfinished();
    const auto result = process("simulate", drive_.simulate_arguments, said(), {}, timeout_s);
    if (result.ok()) writeFileAtomically(stamp_, drive_.stamp);
    return result;
  }
  fs::path said() const { return drive_.folder / "simulate.txt"; }
  /// The truth stays: it is small and what the runs were scored against.
  void remove() const {
    fs::remove(stamp_);
    fs::remove(drive_.log());
  }

 private:
  /// What a simulation that was killed has left: it may be large.
  void removeUnfinished() const {
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(drive_.folder))
      if (entry.path().filename().string().starts_with(".partial.")) left.push_back(entry.path());
    for (const auto& path : left) fs::remove(path);
  }

  const PlannedDrive& drive_;
  fs::path stamp_;
};

RunRecord carryOut(const PlannedRun& run, const PlannedDrive& drive, const Campaign& campaign) {
  fs::remove_all(run.results());  // of an interrupted or outdated run
  fs::remove(run.folder / "run.json");
  RunRecord record;
  record.stamp = run.stamp;
  const fs::path said = run.folder / "run.txt";
  const fs::path scored = run.folder / "evaluate.json";
  const auto failed = [&](const char* verb, const JobResult& result, const fs::path& log) {
    record.failure = complaint(verb, result, log);
    record.exit_code = codeOf(result);
  };
  auto result = process(run.name(), run.run_arguments, said, {}, campaign.timeout_s);
  record.timing = {{"wall_s", result.wall_s}, {"cpu_s", result.cpu_s}};
  // A run that lost input still has results, which are judged like any other's.
  const bool lossy = codeOf(result) == static_cast<int>(ExitCode::kLossy);
  if (!result.ok() && !lossy) failed("run", result, said);
  if (!fs::exists(run.results() / "summary.json")) {
    if (!record.failed()) record.failure = "run: wrote no summary.json";
    return record;
  }
  const fs::path complaints = run.folder / "evaluate.txt";
  result = process(run.name(), run.evaluate_arguments, complaints, scored, campaign.timeout_s);
  if (!result.ok()) {
    if (!record.failed()) failed("evaluate", result, complaints);
    return record;
  }
  try {
    addMetrics(nlohmann::json::parse(contentOf(scored)),
               nlohmann::json::parse(contentOf(run.results() / "summary.json")), record);
    record.nees = neesAtTenths(run.results(), drive.truth());
  } catch (const std::exception& error) {
    if (!record.failed()) record.failure = std::string("results cannot be read: ") + error.what();
  }
  if (!record.failed()) record.failure = failureOf(record, campaign.failure);
  return record;
}

std::string sentence(const PlannedRun& run, const RunRecord& record) {
  const auto ate = record.metrics.find("ate_rmse_m");
  return run.name() + ": " +
         (ate == record.metrics.end() ? "" : "ATE " + formatFixed(ate->second, 3) + " m") +
         (record.failed()
              ? (ate == record.metrics.end() ? "failed: " : ", failed: ") + record.failure
              : "");
}

}  // namespace

std::vector<const PlannedRun*> pendingRuns(const PlannedDrive& drive,
                                           const ResumeOptions& options) {
  std::vector<const PlannedRun*> pending;
  for (const PlannedRun& run : drive.runs) {
    const auto record = readRunRecord(run);
    const bool changed = record && record->stamp != run.stamp;
    if (changed && !options.redo_changed) {
      throw Error(run.name() + " in " + run.folder.string() + " was made in another way (" +
                      stampDifference(record->stamp, run.stamp) +
                      "): add --redo to repeat such runs, or give -o a new folder",
                  ExitCode::kUsage);
    }
    if (!record || changed || (options.retry_failed && record->failed())) pending.push_back(&run);
  }
  return pending;
}

bool runDrive(const PlannedDrive& drive, const Campaign& campaign, const ResumeOptions& options,
              const std::function<void(const std::string&)>& tell) {
  fs::create_directories(drive.folder);
  const FolderLock lock(drive.folder, drive.name());
  const auto pending = pendingRuns(drive, options);
  const DriveLog log(drive);
  const auto finish = [&](const PlannedRun& run, const RunRecord& record) {
    writeRunRecord(run, drive, record);
    if (tell) tell(sentence(run, record));
  };
  try {
    if (!pending.empty() && !log.ready()) {
      const auto result = log.make(campaign.timeout_s);
      if (!result.ok()) {
        for (const PlannedRun* run : pending) {
          RunRecord record;
          record.stamp = run->stamp;
          record.failure = complaint("simulate", result, log.said());
          record.exit_code = codeOf(result);
          finish(*run, record);
        }
        return true;
      }
    }
    for (const PlannedRun* run : pending) finish(*run, carryOut(*run, drive, campaign));
  } catch (const Interrupted&) {
    return false;
  }
  if (!pending.empty() && !options.keep_logs) log.remove();
  return true;
}

}  // namespace colonnade
