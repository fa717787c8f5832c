// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detect_tracking.hpp"

#include <algorithm>

#include "colonnade/base/text.hpp"

namespace colonnade {

void DetectTracking::add(const Frame& frame, const DetectStages::Seen& seen) {
  const double elapsed_s = last_stamp_s_ ? frame.stamp_s - *last_stamp_s_ : 0.0;
  last_stamp_s_ = frame.stamp_s;
  const auto ids = tracker_.step(seen.detections, seen.T_previous_robot, elapsed_s);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (!ids[i]) continue;
    const auto& track = *tracker_.find(*ids[i]);
    if (track.phase == EdgeTracker::Phase::kConfirmed) confirmed_.insert(track.id);
    longest_ = std::max(longest_, track.seen_frames);
    rows_ += formatFixed(frame.stamp_s, 6) + "," + std::to_string(frame.index) + "," +
             std::to_string(i) + "," + std::to_string(track.id) + "," + name(track.phase) + "," +
             std::to_string(track.seen_frames) + "\n";
  }
}

std::string DetectTracking::table() const {
  return "stamp,frame,detection,track,phase,seen_frames\n" + rows_;
}

std::string DetectTracking::text() const {
  return "tracks     " + std::to_string(confirmed_.size()) +
         " edges confirmed, the longest seen in " + std::to_string(longest_) + " frames\n";
}

}  // namespace colonnade
