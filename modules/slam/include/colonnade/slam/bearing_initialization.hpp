// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/initialization_options.hpp"

namespace colonnade {

/// Former poses that wait in the state for later bearings: one for all candidates first seen in one
/// frame, taken out of the state with its last user.
class PoseClones {
 public:
  /// From now on a clone is of the present pose.
  void beginFrame() { present_.reset(); }
  LandmarkId take(EkfSlam& filter);
  void giveBack(LandmarkId clone, EkfSlam& filter);

 private:
  std::optional<LandmarkId> present_;
  std::map<LandmarkId, int> users_;
};

/// One sighting of a candidate in the present frame.
struct BearingSighting {
  Measurement measurement;   ///< bearing alone, radians
  bool confirmed = false;    ///< the detection cycle is complete: it is a thing, no speckle
  double noise_scale = 1.0;  ///< how much the errors of neighbouring frames resemble each other, as
                             ///< in EkfSlam::update
};

/// How the bearings of one candidate become a landmark: one object per candidate, made in the frame
/// of its first sighting (thesis 2015, figures 32 to 34: the parameters start with the detection
/// cycle). The four policies of section 1.4 differ in what waits in the state meanwhile, and in
/// when the place counts as known:
///   delayed         a pose clone; baseline and parallax suffice              [13]
///   gaussian-sum    a pose clone; one term of a sum along the ray is left    [14]
///   sample-entropy  a pose clone; the place is Gaussian enough, eq. (6)      [12]
///   undelayed       a series of landmarks along the ray, which correct the
///                   robot from the second sighting on, eq. (7) to (11)       [11]
class BearingInitialization {
 public:
  struct Verdict {
    enum Kind { kOpen, kFounded, kRejected } kind = kOpen;
    std::optional<LandmarkId> landmark;  ///< when founded
    std::string reason;                  ///< when rejected
  };
  virtual ~BearingInitialization() = default;
  /// The next sighting, after the frame's update. Not to be called after a verdict.
  virtual Verdict see(const BearingSighting& sighting, EkfSlam& filter) = 0;
  /// Takes out of the state whatever the candidate put there, but for a landmark it founded.
  virtual void leave(EkfSlam& filter) = 0;
};

/// A candidate of the policy the options name, from its first sighting at the present pose.
/// Nothing when the bearing is not finite.
std::unique_ptr<BearingInitialization> beginInitialization(const InitializationOptions& options,
                                                           const Measurement& first,
                                                           PoseClones& clones, EkfSlam& filter);

}  // namespace colonnade
