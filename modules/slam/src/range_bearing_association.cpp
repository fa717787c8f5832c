// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_association.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kMostNodes = 20000;
/// Frames with more readings are searched for nearest neighbours only.
constexpr std::size_t kMostJointReadings = 64;

struct Pairing {
  std::size_t reading = 0;
  LandmarkId landmark{};
  double distance2 = 0.0;
  double rank = 0.0;
};

struct Pairings {
  std::vector<std::vector<Pairing>> inside;  ///< for each reading, nearest first
  std::vector<std::vector<LandmarkId>> around;
};

Pairings pair(std::span<const OpenReading> readings, const EkfSlam& filter,
              const OpenAssociationOptions& options) {
  Pairings pairings{std::vector<std::vector<Pairing>>(readings.size()),
                    std::vector<std::vector<LandmarkId>>(readings.size())};
  for (std::size_t r = 0; r < readings.size(); ++r) {
    const double gate = chiSquareQuantile(options.gate_probability,
                                          static_cast<int>(readings[r].measurement.z.size()));
    const double around = std::max(1.0, options.near_factor * options.near_factor) * gate;
    for (const LandmarkId id : readings[r].allowed) {
      if (!filter.mayBeWithin(id, readings[r].measurement, around)) continue;
      const auto innovation = filter.innovation(id, readings[r].measurement);
      if (!innovation) continue;
      const double d2 = innovation->distance2;
      if (d2 <= options.near_factor * options.near_factor * gate) pairings.around[r].push_back(id);
      if (d2 > gate) continue;
      const double rank = options.likelihood ? d2 + std::log(innovation->S.determinant()) : d2;
      pairings.inside[r].push_back({r, id, d2, rank});
    }
    std::stable_sort(pairings.inside[r].begin(), pairings.inside[r].end(),
                     [](const auto& a, const auto& b) { return a.rank < b.rank; });
  }
  return pairings;
}

std::vector<Pairing> nearestNeighbours(const Pairings& pairings) {
  std::vector<Pairing> all, chosen;
  for (const auto& list : pairings.inside) all.insert(all.end(), list.begin(), list.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.rank < b.rank; });
  std::set<std::size_t> readings_used;
  std::set<LandmarkId> landmarks_used;
  for (const Pairing& pairing : all) {
    if (readings_used.contains(pairing.reading) || landmarks_used.contains(pairing.landmark))
      continue;
    readings_used.insert(pairing.reading);
    landmarks_used.insert(pairing.landmark);
    chosen.push_back(pairing);
  }
  return chosen;
}

/// Depth-first branch and bound over the readings that have a pairing at all.
class JointSearch {
 public:
  JointSearch(std::span<const OpenReading> readings, const EkfSlam& filter,
              const Pairings& pairings, double joint_probability)
      : readings_(readings), filter_(filter), probability_(joint_probability) {
    for (const auto& list : pairings.inside)
      if (!list.empty()) levels_.push_back(&list);
    std::stable_sort(levels_.begin(), levels_.end(),
                     [](const auto* a, const auto* b) { return a->size() < b->size(); });
    descend(0, 0.0);
  }
  const std::vector<Pairing>& best() const { return best_; }
  bool exhaustive() const { return nodes_ < kMostNodes; }

 private:
  /// The joint distance never falls when a pair joins, so a branch that can only reach the size of
  /// the best set must already be nearer.
  void descend(std::size_t level, double distance2) {
    if (++nodes_ > kMostNodes) return;
    const std::size_t reachable = chosen_.size() + (levels_.size() - level);
    if (reachable < best_.size() || (reachable == best_.size() && distance2 >= best_distance2_))
      return;
    if (level == levels_.size()) {
      best_ = chosen_;
      best_distance2_ = distance2;
      return;
    }
    for (const Pairing& pairing : *levels_[level]) {
      if (std::any_of(chosen_.begin(), chosen_.end(),
                      [&](const Pairing& c) { return c.landmark == pairing.landmark; }))
        continue;
      chosen_.push_back(pairing);
      matches_.push_back({pairing.landmark, readings_[pairing.reading].measurement});
      dof_ += matches_.back().measurement.z.size();
      const auto joint = filter_.jointDistance2(matches_);
      if (joint && *joint <= chiSquareQuantile(probability_, static_cast<int>(dof_)))
        descend(level + 1, *joint);
      dof_ -= matches_.back().measurement.z.size();
      matches_.pop_back();
      chosen_.pop_back();
    }
    descend(level + 1, distance2);
  }

  std::span<const OpenReading> readings_;
  const EkfSlam& filter_;
  double probability_;
  std::vector<const std::vector<Pairing>*> levels_;
  std::vector<Pairing> chosen_, best_;
  std::vector<Match> matches_;
  Eigen::Index dof_ = 0;
  double best_distance2_ = HUGE_VAL;
  std::size_t nodes_ = 0;
};

}  // namespace

OpenAssociation associateOpen(std::span<const OpenReading> readings, const EkfSlam& filter,
                              const OpenAssociationOptions& options) {
  OpenAssociation result;
  result.landmark.assign(readings.size(), std::nullopt);
  result.near.assign(readings.size(), false);
  const Pairings pairings = pair(readings, filter, options);
  std::vector<Pairing> chosen;
  if (options.joint && readings.size() <= kMostJointReadings) {
    const JointSearch search(readings, filter, pairings, options.joint_probability);
    chosen = search.best();
    result.exhaustive = search.exhaustive();
  } else {
    chosen = nearestNeighbours(pairings);
    result.exhaustive = !options.joint;
  }
  std::set<LandmarkId> used;
  for (const Pairing& pairing : chosen) {
    result.landmark[pairing.reading] = pairing.landmark;
    used.insert(pairing.landmark);
  }
  for (std::size_t r = 0; r < readings.size(); ++r)
    result.near[r] =
        !result.landmark[r] && std::any_of(pairings.around[r].begin(), pairings.around[r].end(),
                                           [&](const LandmarkId id) { return !used.contains(id); });
  return result;
}

}  // namespace colonnade
