// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/jobs/job.hpp"

#include <cstring>
#include <fstream>

#include "colonnade/base/text.hpp"

namespace colonnade {

std::string JobResult::text() const {
  switch (status) {
    case Status::kNotStarted:
      return "not started: " + reason;
    case Status::kTimedOut:
      return "stopped after " + formatFixed(wall_s, 1) + " s: too long";
    case Status::kInterrupted:
      return "interrupted";
    case Status::kExited:
      return exit_code == 0 ? "done" : "exit " + std::to_string(exit_code);
    case Status::kSignalled:
      break;
  }
  const char* short_name = ::sigabbrev_np(signal);
  const char* description = ::sigdescr_np(signal);
  return "killed by " +
         (short_name ? "SIG" + std::string(short_name) : "signal " + std::to_string(signal)) +
         (description ? " (" + std::string(description) + ")" : "");
}

std::filesystem::path thisProgram() {
  std::string path = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string replaced = " (deleted)";
  if (path.ends_with(replaced)) path.resize(path.size() - replaced.size());
  return path;
}

std::string lastLineOf(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    line = trimmed(line);
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace colonnade
