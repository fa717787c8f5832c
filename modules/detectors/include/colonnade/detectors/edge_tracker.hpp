// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/detection.hpp"

namespace colonnade {

struct EdgeTrackingOptions {
  int learning_frames = 5;  ///< thesis 2015, section 2.5: a cycle of 10, 5 and 5
  int checking_frames = 5;
  double cycle_speed_m_s = 0.5;    ///< at which these lengths hold; shorter when faster
  int least_frames = 2;            ///< of a phase, however fast
  int max_missed = 3;              ///< frames in a row after which a track is over
  double gate = radians(1.5);      ///< of the bearing, beyond its sigma and the motion
  double gate_m = 0.25;            ///< of the range, beyond its sigma
  double colour_tolerance = 35.0;  ///< gray levels, mean over B, G, R, on either side
  double width_tolerance = 0.2;    ///< share of the learned width of a pair
  double nearest_m = 1.0;          ///< an edge without range is no nearer
};

/// The learning-checking cycle of the 2015 thesis (section 2.5, figure 19) for all edges at once
/// instead of the widest pair alone. Each edge is followed by where a static line must appear after
/// the robot's motion and by its appearance: sign of the gradient, colour on both sides and, as
/// half of a pair, its width. While learning, a track averages colours and width; while checking it
/// counts hits and misses, and is confirmed with more hits than misses. What moves does not appear
/// where a static line would, two pillars that pass one another differ in range or colour, and two
/// of equal width are two tracks.
class EdgeTracker {
 public:
  enum class Phase { kLearning, kChecking, kConfirmed };

  struct Track {
    int id = 0;
    Phase phase = Phase::kLearning;
    Measurement seen;       ///< last seen or, while missed, predicted
    Appearance appearance;  ///< learned mean
    double width = 0.0;     ///< learned mean, metres or pixels; 0 = no half of a pair
    bool width_in_metres = false;
    int age = 0;               ///< frames since born
    int in_phase = 0;          ///< frames since this phase began
    int hits = 0, misses = 0;  ///< of this phase
    int seen_frames = 0;       ///< in all
    int missed = 0;            ///< in a row, now
    double moved = 0.0;        ///< metres driven since last seen
  };

  explicit EdgeTracker(const EdgeTrackingOptions& options = {}) : options_(options) {}

  /// One frame: for each detection the id of its track; none for what is refused or no pillar edge.
  /// T_previous_robot: motion since the former frame; elapsed_s sets the length of the phases.
  std::vector<std::optional<int>> step(const Detections& detections, const Pose2& T_previous_robot,
                                       double elapsed_s);

  const std::vector<Track>& tracks() const { return tracks_; }  ///< alive now
  const Track* find(int id) const;

 private:
  void predict(Track& track, const Pose2& T_previous_robot) const;
  std::optional<double> mismatch(const Track& track, const Detection& detection) const;
  bool agreesInWidth(const Track& track, const Detections& all, const Detection& detection) const;
  void take(Track& track, const Detections& all, const Detection& detection) const;
  void advance(Track& track, int learning, int checking) const;

  EdgeTrackingOptions options_;
  std::vector<Track> tracks_;
  int next_id_ = 0;
};

const char* name(EdgeTracker::Phase phase);

}  // namespace colonnade
