// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>

#include "colonnade/detectors/edge_tracker.hpp"
#include "detect_stages.hpp"

namespace colonnade {

/// Follows pillar edges from frame to frame, for tracks.csv and a closing line.
class DetectTracking {
 public:
  explicit DetectTracking(const EdgeTrackingOptions& options) : tracker_(options) {}

  void add(const Frame& frame, const DetectStages::Seen& seen);
  /// A row for each sighting: stamp, frame, detection (index in the frame), track, phase,
  /// seen_frames (so far).
  std::string table() const;
  std::string text() const;

 private:
  EdgeTracker tracker_;
  std::optional<double> last_stamp_s_;
  std::set<int> confirmed_;
  int longest_ = 0;
  std::string rows_;
};

}  // namespace colonnade
