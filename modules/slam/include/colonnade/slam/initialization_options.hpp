// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

struct InitializationOptions {
  static constexpr const char* kSection = "Initialization";
  std::string policy = "delayed";
  int sightings = 3;
  int bearing_sightings = 6;
  int patience_frames = 4;
  double same_place_m = 0.25;
  double same_direction = radians(8.0);
  double same_bearing = radians(2.0);
  int max_bearing_candidates = 12;
  int bearing_lifetime_frames = 150;
  int probation_frames = 30;
  int probation_sightings = 8;
  // delayed
  double min_baseline_m = 0.2;
  double min_parallax = radians(5.0);
  // gaussian-sum and undelayed
  double nearest_m = 0.5;
  double farthest_m = 30.0;
  double depth_ratio = 0.3;
  double depth_step = 2.5;
  double prune_share = 0.01;
  // sample-entropy
  double max_entropy = 0.5;
  int entropy_samples = 100;

  void visit(OptionVisitor& v) {
    v.choice("policy", policy, {"delayed", "gaussian-sum", "sample-entropy", "undelayed"},
             "how bearings without range become a landmark");
    v.integer("sightings", sightings, {1, 100}, "before a landmark with range is added");
    v.integer("bearing_sightings", bearing_sightings, {2, 100}, "before a bearing landmark is");
    v.integer("patience_frames", patience_frames, {0, 100}, "a candidate may stay unseen");
    v.number("same_place_m", same_place_m, {0.01, 2}, "between sightings of one candidate");
    v.angle("same_direction_deg", same_direction, {0.5, 45}, "of a floor edge candidate");
    v.angle("same_bearing_deg", same_bearing, {0.1, 20}, "between frames, turn removed");
    v.integer("max_bearing_candidates", max_bearing_candidates, {0, 100}, "followed at a time");
    v.integer("bearing_lifetime_frames", bearing_lifetime_frames, {2, 10000},
              "without becoming a landmark, after which a bearing makes room for another");
    v.integer("probation_frames", probation_frames, {1, 10000},
              "unseen, after which a landmark with too few sightings is purged");
    v.integer("probation_sightings", probation_sightings, {1, 1000},
              "that make a landmark permanent");
    v.number("min_baseline_m", min_baseline_m, {0, 5}, "delayed: across the first ray");
    v.angle("min_parallax_deg", min_parallax, {0.1, 60}, "delayed: between first and present ray");
    v.number("nearest_m", nearest_m, {0.05, 10}, "gaussian-sum, undelayed: nearest landmark");
    v.number("farthest_m", farthest_m, {1, 1000}, "gaussian-sum, undelayed: farthest landmark");
    v.number("depth_ratio", depth_ratio, {0.05, 0.5},
             "gaussian-sum, undelayed: standard deviation of a term over its distance (Sola 2005)");
    v.number("depth_step", depth_step, {1.2, 4},
             "gaussian-sum, undelayed: distance of a term over that of the one before (Sola 2005)");
    v.number("prune_share", prune_share, {0.0001, 0.1},
             "gaussian-sum, undelayed: a term below this share of an equal one is pruned");
    v.number("max_entropy", max_entropy, {0.001, 10},
             "sample-entropy: of the place from its Gaussian, nats (thesis 2015, eq. 6)");
    v.integer("entropy_samples", entropy_samples, {10, 10000}, "sample-entropy: drawn for each");
  }
};

}  // namespace colonnade
