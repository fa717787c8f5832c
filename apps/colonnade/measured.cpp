// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "measured.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "colonnade/base/text.hpp"

namespace colonnade {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

nlohmann::ordered_json timingJson(const std::vector<double>& times_ms) {
  return {{"median", quantile(times_ms, 0.5)},
          {"p95", quantile(times_ms, 0.95)},
          {"max", quantile(times_ms, 1.0)}};
}

double peakResidentMegabytes() {
  // VmHWM begins with this program; ru_maxrss also counts what the process was before exec.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:"))
      if (const auto kilobytes = parseDouble(words(line).at(1))) return *kilobytes / 1024.0;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace colonnade
