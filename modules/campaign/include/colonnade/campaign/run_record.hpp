// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/campaign/plan.hpp"

namespace colonnade {

constexpr std::size_t kInstants = 10;  ///< tenths of a run, the last is its end

/// Normalised innovations of one kind of measurement over one run.
struct InnovationMean {
  double mean = 0.0;    ///< NIS divided by its degrees of freedom: 1 for an honest filter
  std::size_t dof = 0;  ///< of all of them together
};

/// What became of a run that was carried through, well or badly. An interrupted run has no record.
struct RunRecord {
  std::string stamp;
  std::string failure;  ///< why it counts as failed; empty: it does not
  int exit_code = 0;    ///< of the first process that did not end well, 128 + signal
  /// Every number of `evaluate` and the map's sizes: "ate_rmse_m", "landmarks.pillar.recall" ...
  std::map<std::string, double> metrics;
  /// Numbers that differ from one repetition to the next: "frame_ms", "wall_s", "peak_rss_mb" ...
  std::map<std::string, double> timing;
  std::map<std::string, InnovationMean> nis;
  /// NEES of the pose divided by 3 at the tenths of the run; absent where the data cannot tell.
  std::array<std::optional<double>, kInstants> nees{};

  bool failed() const { return !failure.empty(); }
};

/// Written beside the results as run.json, with the command lines.
void writeRunRecord(const PlannedRun& run, const PlannedDrive& drive, const RunRecord& record);
/// Nothing where the run was not carried through yet. Throws Error for a damaged file.
std::optional<RunRecord> readRunRecord(const PlannedRun& run);

/// The first line in which two stamps differ, for people: "world: a, now b".
std::string stampDifference(const std::string& former, const std::string& now);

/// Takes the numbers of `evaluate --json` and of a results folder's summary.json. Objects become
/// dotted names; lists and null are left out.
void addMetrics(const nlohmann::json& evaluation, const nlohmann::json& summary, RunRecord& record);

/// NEES / 3 at the tenths of the estimate's time: the pose with a covariance nearest to each.
std::array<std::optional<double>, kInstants> neesAtTenths(const std::filesystem::path& results,
                                                          const std::filesystem::path& truth);

/// Why a run whose processes ended well counts as failed, or "".
std::string failureOf(const RunRecord& record, const FailureRule& rule);

}  // namespace colonnade
