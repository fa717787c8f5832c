// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace colonnade {

/// What the program tells the shell.
enum class ExitCode {
  kDone = 0,
  kFailed = 1,
  kUsage = 2,         ///< wrong options or configuration
  kLossy = 3,         ///< done, but input was lost or damaged; the summary counts it
  kInterrupted = 130  ///< stopped by a signal, results written
};

/// An error a user can act on: one line saying what, where and what to do.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ExitCode code = ExitCode::kFailed)
      : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace colonnade
