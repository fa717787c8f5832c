// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

#include "colonnade/jobs/job.hpp"

namespace colonnade {

/// One child process that has begun. Its destructor leaves none behind: it kills and reaps.
class Child {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begins the job. A program that cannot be executed gives a child that is over at once, with the
  /// reason; a log that cannot be written throws Error.
  explicit Child(const Job& job);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Signals the child and what it started.
  void signal(int number) const;
  /// Asks it to end; SIGKILL follows at `deadline`. `why`: what its status will be.
  void stop(int number, JobResult::Status why, Clock::time_point deadline);
  /// Acts on what is due now: timeout, SIGKILL after the grace.
  void enforce(double grace_s);
  /// The next time enforce() has something to do.
  std::optional<Clock::time_point> due() const;
  /// The result, once it has ended. Never blocks.
  std::optional<JobResult> result();

 private:
  pid_t pid_ = -1;
  JobResult result_;
  Clock::time_point began_ = Clock::now();
  std::optional<Clock::time_point> timeout_;
  std::optional<Clock::time_point> kill_;
  std::optional<JobResult::Status> stopped_as_;
};

}  // namespace colonnade
