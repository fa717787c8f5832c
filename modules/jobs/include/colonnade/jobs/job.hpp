// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace colonnade {

/// One child process. No shell is between: every argument arrives as it stands here.
struct Job {
  std::string name;                    ///< for messages
  std::vector<std::string> arguments;  ///< after the program's name
  std::filesystem::path program;       ///< empty: the program that is running, such as colonnade
  std::filesystem::path log;     ///< standard error and, unless `output`, standard output; replaced
  std::filesystem::path output;  ///< standard output alone; replaced
  double timeout_s = 0.0;        ///< 0: none
};

/// How a child ended.
struct JobResult {
  enum class Status {
    kNotStarted,   ///< never began: see `reason`
    kExited,       ///< by itself: see `exit_code`
    kSignalled,    ///< by a signal: see `signal`
    kTimedOut,     ///< ended because its time was over
    kInterrupted,  ///< ended because this process was told to stop
  };
  std::string name;
  Status status = Status::kNotStarted;
  int exit_code = -1;
  int signal = 0;
  std::string reason = "not begun";
  double wall_s = 0.0;
  double cpu_s = 0.0;        ///< user and system, of the child and those it waited for
  double peak_rss_mb = 0.0;  ///< MiB; never below what this process held when it began the child

  bool ok() const { return status == Status::kExited && exit_code == 0; }
  /// "done", "exit 3", "killed by SIGSEGV (Segmentation fault)", "stopped after its 10 s" ...
  std::string text() const;
};

/// The program that is running, however it was started; still valid when its file was replaced.
std::filesystem::path thisProgram();

/// The last line of a log that is not empty, or "" when there is none: what a failed job said.
std::string lastLineOf(const std::filesystem::path& log);

}  // namespace colonnade
