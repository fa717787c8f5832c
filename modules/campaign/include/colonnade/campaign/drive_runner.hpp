// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "colonnade/campaign/plan.hpp"
#include "colonnade/campaign/run_record.hpp"

namespace colonnade {

/// What stands in the way of using or repeating a former run.
struct ResumeOptions {
  bool redo_changed = false;  ///< repeat runs whose stamp differs, instead of refusing
  bool retry_failed = false;  ///< repeat runs that failed
  bool keep_logs = false;     ///< keep the simulated logs of drives that are done
};

/// The runs of a drive that are still to be done. Throws Error (kUsage) where a former run was made
/// in another way (stampDifference) and `redo_changed` is off.
std::vector<const PlannedRun*> pendingRuns(const PlannedDrive& drive, const ResumeOptions& options);

/// Carries out what is pending of a drive in child processes, one after the other: the log, unless
/// it is there, then `run` and `evaluate` for each configuration. Remnants of an interrupted run
/// are removed first. Returns false when it was interrupted; what was finished by then stays.
/// `tell` gets one line per run. Throws Error when another process is at the same drive.
bool runDrive(const PlannedDrive& drive, const Campaign& campaign, const ResumeOptions& options,
              const std::function<void(const std::string&)>& tell = {});

}  // namespace colonnade
