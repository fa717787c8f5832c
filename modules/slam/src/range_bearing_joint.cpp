// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_joint.hpp"

#include <map>

#include "colonnade/slam/range_bearing_association.hpp"

namespace colonnade {
namespace {

/// Readings without identity that found nothing: so many in one frame are no landmarks.
constexpr int kMostBirths = 100;

struct Plan {
  std::vector<std::optional<LandmarkId>> landmark;
  std::vector<bool> may_found;
};

/// Readings of identities the map knows; of several with one identity the nearest counts.
void planKnown(const ReadingFrame& frame, RangeBearingHypothesis& hypothesis, Plan& plan) {
  std::map<int, std::size_t> reading_of_identity;
  for (std::size_t i = 0; i < frame.readings.size(); ++i) {
    const int identity = frame.readings[i].identity;
    if (identity < 0) continue;
    const auto [former, fresh] = reading_of_identity.emplace(identity, i);
    if (fresh) continue;
    const auto bearer = hypothesis.landmarkOf(identity);
    const auto distance = [&](std::size_t reading) {
      const auto innovation =
          bearer ? hypothesis.filter.innovation(*bearer, frame.readings[reading].measurement)
                 : std::nullopt;
      return innovation ? innovation->distance2 : HUGE_VAL;
    };
    const std::size_t nearest = distance(i) < distance(former->second) ? i : former->second;
    plan.may_found[nearest == i ? former->second : i] = false;
    former->second = nearest;
    hypothesis.filter.health().refuse("identity repeated in one frame");
  }
  for (const auto& [identity, reading] : reading_of_identity)
    plan.landmark[reading] = hypothesis.landmarkOf(identity);
}

/// The others: among landmarks no known reading is of.
void planOpen(const ReadingFrame& frame, const RangeBearingOptions& options,
              RangeBearingHypothesis& hypothesis, Plan& plan) {
  std::vector<OpenReading> open;
  std::vector<std::size_t> places;
  for (const auto& landmark : plan.landmark)
    if (landmark) hypothesis.used.push_back(*landmark);
  for (std::size_t i = 0; i < frame.readings.size(); ++i) {
    if (plan.landmark[i] || !plan.may_found[i]) continue;
    auto allowed = hypothesis.allowed(frame.readings[i].identity);
    if (allowed.empty()) continue;
    open.push_back({frame.readings[i].measurement, std::move(allowed)});
    places.push_back(i);
  }
  hypothesis.used.clear();
  if (open.empty()) return;
  OpenAssociationOptions how;
  how.joint = options.association != "nn";
  how.likelihood = options.metric == "likelihood";
  how.gate_probability = options.gate_probability;
  how.joint_probability = options.joint_probability;
  how.near_factor = options.near_factor;
  const auto association = associateOpen(open, hypothesis.filter, how);
  for (std::size_t k = 0; k < open.size(); ++k) {
    const std::size_t i = places[k];
    plan.landmark[i] = association.landmark[k];
    // A reading whose identity is new may found a landmark beside another one.
    if (association.near[k] && frame.readings[i].identity < 0) plan.may_found[i] = false;
  }
}

}  // namespace

ReadingDecisions decideJointly(const ReadingFrame& frame, const RangeBearingOptions& options,
                               RangeBearingHypothesis& hypothesis) {
  const std::size_t count = frame.readings.size();
  Plan plan{std::vector<std::optional<LandmarkId>>(count), std::vector<bool>(count, true)};
  planKnown(frame, hypothesis, plan);
  planOpen(frame, options, hypothesis, plan);

  std::vector<Match> matches;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < count; ++i) {
    if (!plan.landmark[i]) continue;
    matches.push_back({*plan.landmark[i], frame.readings[i].measurement});
    places.push_back(i);
  }
  const auto used = hypothesis.update(matches, frame.noise_scale);

  ReadingDecisions decisions;
  std::vector<std::optional<LandmarkId>> landmarks(count);
  decisions.founded.assign(count, false);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::size_t i = places[k];
    plan.may_found[i] = false;
    if (used[k]) {
      landmarks[i] = plan.landmark[i];
      hypothesis.observe(*landmarks[i], frame.readings[i], frame);
    } else {
      decisions.lost |= hypothesis.strike(*plan.landmark[i], frame, decisions.events);
    }
  }
  int births = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!plan.may_found[i]) continue;
    if (!hypothesis.grows()) {
      hypothesis.refuseNew();
      continue;
    }
    if (frame.readings[i].identity < 0 && ++births > kMostBirths) {
      hypothesis.filter.health().refuse("too many new landmarks in one frame");
      continue;
    }
    landmarks[i] = frame.readings[i].measurement.hasRange()
                       ? hypothesis.found(frame.readings[i], frame, decisions.events)
                       : hypothesis.triangulate(frame.readings[i], frame, decisions.events);
    decisions.founded[i] = landmarks[i].has_value();
  }
  decisions.landmarks.push_back(std::move(landmarks));
  hypothesis.endFrame(frame, decisions.events);
  return decisions;
}

}  // namespace colonnade
