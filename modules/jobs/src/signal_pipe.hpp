// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <csignal>
#include <vector>

namespace colonnade {

/// While one lives, SIGCHLD, SIGINT, SIGTERM and SIGHUP arrive as bytes in a pipe, whichever thread
/// the kernel picks. Former handlers return with its end. One at a time in a process.
class SignalPipe {
 public:
  SignalPipe();
  ~SignalPipe();
  SignalPipe(const SignalPipe&) = delete;
  SignalPipe& operator=(const SignalPipe&) = delete;

  /// The signals since the last call; waits up to timeout_ms for the first (-1: for ever).
  std::vector<int> wait(int timeout_ms);

 private:
  static constexpr std::array<int, 4> kSignals{SIGCHLD, SIGINT, SIGTERM, SIGHUP};
  int read_end_ = -1;
  int write_end_ = -1;
  std::array<struct sigaction, kSignals.size()> former_{};
};

}  // namespace colonnade
