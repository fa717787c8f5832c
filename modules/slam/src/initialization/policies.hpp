// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/slam/bearing_initialization.hpp"

namespace colonnade {

using InitializationPolicy = std::unique_ptr<BearingInitialization>(
    const InitializationOptions& options, const Measurement& first, PoseClones& clones,
    EkfSlam& filter);
InitializationPolicy beginDelayed;
InitializationPolicy beginGaussianSum;
InitializationPolicy beginSampleEntropy;
InitializationPolicy beginUndelayed;

/// A candidate whose first pose waits in the state as a clone.
class ClonedInitialization : public BearingInitialization {
 public:
  ClonedInitialization(const Measurement& first, PoseClones& clones, EkfSlam& filter)
      : first_(first), clones_(clones), clone_(clones.take(filter)) {}
  void leave(EkfSlam& filter) override { clones_.giveBack(clone_, filter); }

 protected:
  const Measurement& first() const { return first_; }
  LandmarkId clone() const { return clone_; }
  /// The landmark of the first and the present bearing, or a rejection.
  Verdict foundByTwoBearings(const Measurement& now, EkfSlam& filter) const {
    const auto id = filter.addLandmark(clone_, first_, now);
    if (!id) return {Verdict::kRejected, {}, "rays do not meet"};
    return {Verdict::kFounded, id, {}};
  }

 private:
  Measurement first_;
  PoseClones& clones_;
  LandmarkId clone_;
};

}  // namespace colonnade
