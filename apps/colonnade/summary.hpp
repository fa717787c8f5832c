// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/frames/frame_source.hpp"
#include "colonnade/maps/map_recorder.hpp"
#include "run_recorder.hpp"

namespace colonnade {

/// What summary.json tells of a run. Everything but timing_ms, realtime_factor and peak_rss_mb is
/// the same for the same log, configuration and program.
struct RunSummary {
  std::size_t frames = 0;  ///< in the log, refused observations included
  std::size_t frames_processed = 0;
  LandmarkMap landmarks;
  std::size_t axes = 0;
  std::optional<TrajectoryScore> score;        ///< as estimated online
  std::optional<TrajectoryScore> final_score;  ///< as known at the end
  Damage damage;
  double wall_seconds = 0.0;
  MapFiles maps;
  bool interrupted = false;
};

nlohmann::ordered_json toJson(const RunSummary& summary, const RunRecorder& recorder,
                              const InnovationHealth& health);

/// The same for a person, a few lines.
std::string toText(const nlohmann::ordered_json& summary);

}  // namespace colonnade
