// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "colonnade/jobs/job.hpp"
#include "compare_methods.hpp"

namespace colonnade {

/// What one run of a method came to. Figures the run cannot tell are absent.
struct RunOutcome {
  std::string failure;  ///< by the written rule; empty: it passed
  std::string remark;   ///< such as lost input; no failure
  /// ate_m, rpe_1m_percent, drift_percent, heading_deg, coverage, lost_frames, landmarks,
  /// landmarks_per_frame, points, points_per_frame, frame_ms_median, frame_ms_p95, map_ms_median,
  /// peak_rss_mb, map_bytes, path_length_m, frames, wall_s, cpu_s
  std::map<std::string, double> figures;
};

struct MethodOutcome {
  ComparedMethod method;
  std::vector<RunOutcome> runs;  ///< empty where the log lacks what it needs

  std::size_t failures() const;
  /// Values of a figure over all runs that tell it, sorted.
  std::vector<double> values(const std::string& figure) const;
};

/// When a run counts as failed, for people.
std::string failureRule();

/// Reads what a run left in `folder` and judges it by failureRule().
RunOutcome outcomeOf(const JobResult& job, const std::filesystem::path& folder,
                     const std::filesystem::path& log);

}  // namespace colonnade
