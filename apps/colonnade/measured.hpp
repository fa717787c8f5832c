// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

namespace colonnade {

/// The value below which `share` of the values lie (0.5: the lower median); 0 without values.
double quantile(std::vector<double> values, double share);
/// {"median", "p95", "max"} of a stage's times, as in summary.json.
nlohmann::ordered_json timingJson(const std::vector<double>& times_ms);
/// The most memory this process has held so far.
double peakResidentMegabytes();

}  // namespace colonnade
