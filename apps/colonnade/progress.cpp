// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "colonnade/base/text.hpp"

namespace colonnade {

Progress::Progress() : terminal_(::isatty(STDERR_FILENO) == 1) {}

void Progress::show(double share, std::size_t frames, const std::string& detail) {
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
  const int eta = share > 0.01 ? static_cast<int>(elapsed * (1.0 - share) / share) : 0;
  std::string text = std::to_string(percent) + " %  frame " + std::to_string(frames) + "  " +
                     formatFixed(static_cast<double>(frames) / std::max(elapsed, 1e-3), 0) +
                     " frames/s  ETA " + std::to_string(eta / 60) + ":" +
                     (eta % 60 < 10 ? "0" : "") + std::to_string(eta % 60) + "  " + detail;
  if (terminal_) {
    if (std::chrono::duration<double>(now - last_shown_).count() < 0.1) return;
    const auto bar = static_cast<std::size_t>(percent / 5);
    text = "[" + std::string(bar, '#') + std::string(20 - bar, '-') + "]  " + text;
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    line_open_ = true;
  } else if (percent >= 10 * next_tenth_) {
    std::fprintf(stderr, "%s\n", text.c_str());
    next_tenth_ = percent / 10 + 1;
  }
  last_shown_ = now;
}

void Progress::finish() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

}  // namespace colonnade
