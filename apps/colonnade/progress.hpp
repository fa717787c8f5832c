// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace colonnade {

/// Tells how far a long verb is, on stderr: one line that rewrites itself on a terminal, a plain
/// line at every tenth in a pipe.
class Progress {
 public:
  Progress();
  /// share: 0 to 1; detail: what to show beside it.
  void show(double share, std::size_t frames, const std::string& detail);
  /// Ends the line of a terminal.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_ = Clock::now();
  bool terminal_;
  bool line_open_ = false;
  int next_tenth_ = 1;
};

}  // namespace colonnade
