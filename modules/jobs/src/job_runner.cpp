// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/jobs/job_runner.hpp"

#include <algorithm>
#include <csignal>
#include <map>

#include "child.hpp"
#include "colonnade/base/error.hpp"
#include "signal_pipe.hpp"

namespace colonnade {
namespace {

using Clock = Child::Clock;

/// Milliseconds until the first child has something due; a look every second in any case.
int timeoutOf(const std::map<std::size_t, Child>& children) {
  auto first = Clock::now() + std::chrono::seconds(1);
  for (const auto& [index, child] : children)
    if (const auto due = child.due()) first = std::min(first, *due);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(first - Clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

}  // namespace

JobRunner::JobRunner(JobRunnerOptions options) : options_(options) {
  if (options_.parallel < 1) throw Error("at least one job must run at a time", ExitCode::kUsage);
}

std::vector<JobResult> JobRunner::run(const std::vector<Job>& jobs, const Observer& observer) {
  interrupted_ = false;
  std::vector<JobResult> results(jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) results[i].name = jobs[i].name;
  SignalPipe signals;
  std::map<std::size_t, Child> children;
  std::size_t next = 0;
  std::size_t ended = 0;
  const auto tell = [&](JobEvent::Kind kind, std::size_t index, const JobResult* result) {
    if (observer) observer({kind, index, result, children.size(), ended, jobs.size()});
  };

  const auto obey = [&](const std::vector<int>& arrived) {
    for (const int signal : arrived) {
      if (signal == SIGCHLD) continue;
      const auto grace = std::chrono::duration<double>(interrupted_ ? 0.0 : options_.grace_s);
      const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(grace);
      for (auto& [index, child] : children)
        child.stop(SIGINT, JobResult::Status::kInterrupted, deadline);
      interrupted_ = true;
    }
  };
  const auto begins = [&] {
    return !interrupted_ && next < jobs.size() &&
           children.size() < static_cast<std::size_t>(options_.parallel);
  };

  while (true) {
    obey(signals.wait(0));  // before anything new begins
    while (begins()) {
      children.emplace(next, Child(jobs[next]));
      tell(JobEvent::Kind::kBegan, next, nullptr);
      ++next;
    }
    for (auto at = children.begin(); at != children.end();) {
      const auto result = at->second.result();
      if (!result) {
        ++at;
        continue;
      }
      const std::size_t index = at->first;
      at = children.erase(at);
      results[index] = *result;
      ++ended;
      tell(JobEvent::Kind::kEnded, index, &results[index]);
    }
    if (children.empty() && (interrupted_ || next == jobs.size())) break;
    if (begins()) continue;
    obey(signals.wait(timeoutOf(children)));
    for (auto& [index, child] : children) child.enforce(options_.grace_s);
  }
  return results;
}

}  // namespace colonnade
