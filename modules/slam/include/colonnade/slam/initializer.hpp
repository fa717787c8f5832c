// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "colonnade/frames/frame.hpp"
#include "colonnade/slam/association.hpp"
#include "colonnade/slam/bearing_candidates.hpp"
#include "colonnade/slam/event.hpp"
#include "colonnade/slam/initialization_options.hpp"

namespace colonnade {

/// Turns detections nobody knows into landmarks. With range or on the floor: immediately, once seen
/// a few times at one place of the world. Bearings: by the policy the options name. A candidate
/// that is dropped leaves no trace; a landmark hardly seen after its birth is purged.
class Initializer {
 public:
  explicit Initializer(const InitializationOptions& options)
      : options_(options), bearings_(std::make_unique<BearingCandidates>(options)) {}
  /// A copy follows no bearings yet: what those of the other hold in the state must be taken out of
  /// the state that goes with the copy.
  Initializer(const Initializer& other)
      : options_(other.options_),
        candidates_(other.candidates_),
        bearings_(std::make_unique<BearingCandidates>(other.options_)),
        former_stamp_s_(other.former_stamp_s_),
        unseen_(other.unseen_) {}
  Initializer(Initializer&&) = default;
  Initializer& operator=(Initializer&&) = default;

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

  bool recognise(const Detection& detection, const EkfSlam& filter);
  void found(const Frame& frame, EkfSlam& filter, LandmarkBook& book, std::vector<Event>& events);
  void foundFromBearings(const Frame& frame, const std::vector<Detection>& unknown, EkfSlam& filter,
                         LandmarkBook& book, std::vector<Event>& events);
  void endProbation(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                    std::vector<Event>& events);

  InitializationOptions options_;
  std::vector<Candidate> candidates_;
  std::unique_ptr<BearingCandidates> bearings_;
  std::optional<double> former_stamp_s_;
  std::vector<std::pair<LandmarkId, int>> unseen_;  ///< young landmarks, frames since last seen
};

}  // namespace colonnade
