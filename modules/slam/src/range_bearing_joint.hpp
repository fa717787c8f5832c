// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "range_bearing_hypothesis.hpp"

namespace colonnade {

/// What was decided about the readings of one frame.
struct ReadingDecisions {
  /// For each hypothesis, for each reading.
  std::vector<std::vector<std::optional<LandmarkId>>> landmarks;
  std::vector<bool> founded;  ///< by the likeliest hypothesis
  std::vector<Event> events;
  bool lost = false;  ///< every landmark disagreed: the pose was put in doubt, see lostCovariance()
};

/// All readings of a frame at once: known identities and nn or jcbb for the others, one joint
/// correction, then new landmarks.
ReadingDecisions decideJointly(const ReadingFrame& frame, const RangeBearingOptions& options,
                               RangeBearingHypothesis& hypothesis);

}  // namespace colonnade
