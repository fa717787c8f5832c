// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/slam/bearing_initialization.hpp"

namespace colonnade {

/// Bearings without range that are no landmark yet, followed from frame to frame by their direction,
/// its rate and the side of their dark half; nearest pairs first. Each has a policy of its own that says when it is a landmark; a
/// candidate that is dropped takes everything of it out of the state.
class BearingCandidates {
 public:
  explicit BearingCandidates(const InitializationOptions& options) : options_(options) {}
  // The policies hold a reference to the clones.
  BearingCandidates(const BearingCandidates&) = delete;
  BearingCandidates& operator=(const BearingCandidates&) = delete;

  struct Founded {
    LandmarkId landmark{};
    Detection detection;  ///< the last sighting
    int age = 0;          ///< frames since the first sighting
  };
  struct Step {
    std::vector<Founded> founded;
    std::vector<std::string> rejected;  ///< reasons
  };
  /// One frame, after the update: the bearings nobody knows.
  Step step(const std::vector<Detection>& unknown, double noise_scale, EkfSlam& filter);
  std::size_t size() const { return candidates_.size(); }

 private:
  struct Candidate {
    std::unique_ptr<BearingInitialization> place;
    Detection last;
    double world_bearing = 0.0;  ///< at the last sighting
    double rate = 0.0;           ///< of the world bearing, radians per frame
    int sightings = 1;
    int unseen = 0;
    int age = 0;
    bool over = false;
  };
  void recognise(const std::vector<Detection>& unknown, const EkfSlam& filter,
                 std::vector<bool>& fresh);

  InitializationOptions options_;
  PoseClones clones_;
  std::vector<Candidate> candidates_;
};

}  // namespace colonnade
