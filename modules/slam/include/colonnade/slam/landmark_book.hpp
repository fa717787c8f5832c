// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_looks.hpp"

namespace colonnade {

/// What is known of landmarks beside their geometry: how they look and which belong together.
class LandmarkBook {
 public:
  /// Counts an observation: stamps, seen extent of floor edges, appearance.
  void observe(LandmarkId landmark, const Detection& detection, double stamp_s, EkfSlam& filter);
  /// The two edges of one pillar were seen together.
  void observePair(LandmarkId a, LandmarkId b);
  void forget(LandmarkId landmark);

  /// Whether a detection can be this landmark by its looks: a vertical edge keeps its dark side.
  bool looksLike(LandmarkId landmark, const Detection& detection) const;

  /// nullptr for a landmark never observed.
  const LandmarkLooks* looks(LandmarkId landmark) const;

  /// Fills pair_id where two edges are each other's most frequent partner, seen together three
  /// times or more.
  void fillPairs(LandmarkMap& map) const;

 private:
  struct Page {
    LandmarkLooks looks;
    std::map<LandmarkId, int> partners;
  };
  std::optional<LandmarkId> bestPartner(LandmarkId landmark) const;
  std::map<LandmarkId, Page> pages_;
};

}  // namespace colonnade
