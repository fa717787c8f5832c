// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/bearing_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// Of the newest rate in the smoothed one: the noise of a bearing is as large as its rate.
constexpr double kRateGain = 0.3;

}  // namespace

BearingCandidates::Step BearingCandidates::step(const std::vector<Detection>& unknown,
                                                double noise_scale, EkfSlam& filter) {
  clones_.beginFrame();
  for (Candidate& candidate : candidates_) {
    ++candidate.unseen;
    ++candidate.age;
  }
  // All are recognised before any of them moves the robot.
  std::vector<bool> fresh(unknown.size(), true);
  recognise(unknown, filter, fresh);

  Step step;
  for (Candidate& candidate : candidates_) {
    if (candidate.unseen == 0) {
      const auto verdict =
          candidate.place->see({candidate.last.measurement,
                                candidate.sightings >= options_.bearing_sightings, noise_scale},
                               filter);
      if (verdict.kind == BearingInitialization::Verdict::kFounded)
        step.founded.push_back({*verdict.landmark, candidate.last, candidate.age});
      if (verdict.kind == BearingInitialization::Verdict::kRejected)
        step.rejected.push_back(verdict.reason);
      candidate.over = verdict.kind != BearingInitialization::Verdict::kOpen;
    }
    candidate.over = candidate.over || candidate.unseen > options_.patience_frames ||
                     candidate.age > options_.bearing_lifetime_frames;
    if (candidate.over) candidate.place->leave(filter);
  }
  std::erase_if(candidates_, [](const Candidate& candidate) { return candidate.over; });

  for (std::size_t d = 0; d < unknown.size(); ++d) {
    if (!fresh[d]) continue;
    if (static_cast<int>(candidates_.size()) >= options_.max_bearing_candidates) break;
    if (auto place = beginInitialization(options_, unknown[d].measurement, clones_, filter))
      candidates_.push_back(
          {std::move(place), unknown[d], filter.pose().phi + unknown[d].measurement.z(0)});
  }
  return step;
}

void BearingCandidates::recognise(const std::vector<Detection>& unknown, const EkfSlam& filter,
                                  std::vector<bool>& fresh) {
  struct Pair {
    double off;
    std::size_t detection;
    Candidate* candidate;
  };
  std::vector<Pair> pairs;
  for (std::size_t d = 0; d < unknown.size(); ++d)
    for (Candidate& candidate : candidates_) {
      const double expected = candidate.world_bearing + candidate.rate * candidate.unseen;
      const double off =
          std::abs(wrapAngle(filter.pose().phi + unknown[d].measurement.z(0) - expected));
      if (off <= options_.same_bearing * candidate.unseen &&
          candidate.last.appearance.gradient_sign == unknown[d].appearance.gradient_sign)
        pairs.push_back({off, d, &candidate});
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.off < b.off; });
  for (const Pair& pair : pairs) {
    Candidate& candidate = *pair.candidate;
    if (!fresh[pair.detection] || candidate.unseen == 0) continue;
    fresh[pair.detection] = false;
    const double bearing = filter.pose().phi + unknown[pair.detection].measurement.z(0);
    const double rate = wrapAngle(bearing - candidate.world_bearing) / candidate.unseen;
    candidate.rate += kRateGain * (rate - candidate.rate);
    candidate.world_bearing = bearing;
    candidate.last = unknown[pair.detection];
    candidate.unseen = 0;
    ++candidate.sightings;
  }
}

}  // namespace colonnade
