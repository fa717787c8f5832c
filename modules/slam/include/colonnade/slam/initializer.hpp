// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/slam/association.hpp"
#include "colonnade/slam/event.hpp"

namespace colonnade {

struct InitializationOptions {
  static constexpr const char* kSection = "Initialization";
  int sightings = 3;
  int bearing_sightings = 6;
  int patience_frames = 4;
  double same_place_m = 0.25;
  double same_direction = radians(8.0);
  double same_bearing = radians(2.0);
  double min_baseline_m = 0.2;
  double min_parallax = radians(5.0);
  int max_bearing_candidates = 12;
  int bearing_lifetime_frames = 150;
  int probation_frames = 30;
  int probation_sightings = 8;

  void visit(OptionVisitor& v) {
    v.integer("sightings", sightings, {1, 100}, "before a landmark with range is added");
    v.integer("bearing_sightings", bearing_sightings, {2, 100}, "before a bearing landmark is");
    v.integer("patience_frames", patience_frames, {0, 100}, "a candidate may stay unseen");
    v.number("same_place_m", same_place_m, {0.01, 2}, "between sightings of one candidate");
    v.angle("same_direction_deg", same_direction, {0.5, 45}, "of a floor edge candidate");
    v.angle("same_bearing_deg", same_bearing, {0.1, 20}, "between frames, turn removed");
    v.number("min_baseline_m", min_baseline_m, {0, 5}, "across the first ray");
    v.angle("min_parallax_deg", min_parallax, {0.1, 60}, "between first and present ray");
    v.integer("max_bearing_candidates", max_bearing_candidates, {0, 100}, "followed at a time");
    v.integer("bearing_lifetime_frames", bearing_lifetime_frames, {2, 10000},
              "without enough parallax, after which a bearing makes room for another");
    v.integer("probation_frames", probation_frames, {1, 10000},
              "unseen, after which a landmark with too few sightings is purged");
    v.integer("probation_sightings", probation_sightings, {1, 1000},
              "that make a landmark permanent");
  }
};

/// Turns detections nobody knows into landmarks. With range or on the floor: at once, after a few
/// sightings at one place of the world. Bearings: delayed until baseline and parallax allow (thesis
/// 2015, section 1.4, reference [13]); the pose of the first sighting waits in the state, so that
/// the new landmark gets its true correlations. A candidate that is dropped leaves no trace.
class Initializer {
 public:
  explicit Initializer(const InitializationOptions& options) : options_(options) {}

  /// One frame, after the update. Appends what happened to `events`.
  void step(const Frame& frame, const Detections& detections, const Association& association,
            EkfSlam& filter, LandmarkBook& book, std::vector<Event>& events);

 private:
  struct Candidate {
    Detection last;
    Eigen::Vector3d key;  ///< point: x, y, 0; floor edge: foot of the camera's normal, direction
    int sightings = 1;
    int unseen = 0;
  };
  struct BearingCandidate {
    LandmarkId clone{};
    Measurement first;
    Detection last;
    Pose2 T_world_robot_last;
    int sightings = 1;
    int unseen = 0;
    int age = 0;  ///< frames
  };

  bool stepCandidate(const Detection& detection, const EkfSlam& filter);
  bool stepBearing(const Detection& detection, const EkfSlam& filter);
  void found(const Frame& frame, EkfSlam& filter, LandmarkBook& book, std::vector<Event>& events);
  void foundFromBearings(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                         std::vector<Event>& events);
  void dropStale(EkfSlam& filter);
  void releaseClone(LandmarkId clone, EkfSlam& filter);
  void endProbation(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                    std::vector<Event>& events);

  InitializationOptions options_;
  std::vector<Candidate> candidates_;
  std::vector<BearingCandidate> bearings_;
  std::vector<std::pair<LandmarkId, int>> unseen_;  ///< young landmarks, frames since last seen
};

}  // namespace colonnade
