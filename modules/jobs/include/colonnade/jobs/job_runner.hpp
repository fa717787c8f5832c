// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "colonnade/jobs/job.hpp"

namespace colonnade {

struct JobRunnerOptions {
  int parallel = 1;       ///< children at a time
  double grace_s = 20.0;  ///< from the request to stop (timeout or interruption) to SIGKILL
};

/// What happened to the jobs as a whole when one of them began or ended.
struct JobEvent {
  enum class Kind { kBegan, kEnded };
  Kind kind;
  std::size_t index;        ///< of the job
  const JobResult* result;  ///< when it ended
  std::size_t running;
  std::size_t ended;
  std::size_t total;
};

/// Runs child processes, some at a time, and waits for all of them.
///
/// While it runs, SIGINT, SIGTERM and SIGHUP are caught: children get SIGINT, no further job
/// begins, and what has not ended after `grace_s`, or at a second signal, is killed. Each child
/// leads a process group of its own, which is signalled as a whole. When this process is killed
/// outright the kernel kills its children (PR_SET_PDEATHSIG); grandchildren then only if they came
/// about through a JobRunner too.
class JobRunner {
 public:
  using Observer = std::function<void(const JobEvent&)>;

  /// Throws Error(kUsage) unless at least one child may run.
  explicit JobRunner(JobRunnerOptions options = {});

  /// One result per job, in the order of the jobs. What a job does wrong is in its result; an
  /// exception of the observer ends all children. Throws Error when a log cannot be written.
  std::vector<JobResult> run(const std::vector<Job>& jobs, const Observer& observer = {});
  /// Whether the last run() was told to stop.
  bool interrupted() const { return interrupted_; }

 private:
  JobRunnerOptions options_;
  bool interrupted_ = false;
};

}  // namespace colonnade
