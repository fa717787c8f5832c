// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "measured.hpp"

#include <sys/resource.h>

#include <algorithm>

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
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace colonnade
