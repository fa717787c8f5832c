// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_beam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

/// Histories less likely than the best one by this factor (natural logarithm) are dropped.
constexpr double kLeastLogWeight = -20.0;
/// Decisions after which two histories that agree are one.
constexpr int kMemory = 60;

enum class Choice { kLandmark, kBirth, kOutlier };

struct Child {
  std::size_t parent = 0;
  Choice choice = Choice::kOutlier;
  LandmarkId landmark{};
  double log_weight = 0.0;
};

/// Log density of the innovation.
double logLikelihood(const Innovation& innovation) {
  const auto size = static_cast<double>(innovation.nu.size());
  return -0.5 *
         (innovation.distance2 + size * std::log(2.0 * kPi) + std::log(innovation.S.determinant()));
}

class Beam {
 public:
  Beam(const RangeBearingOptions& options, std::vector<RangeBearingHypothesis>& hypotheses)
      : options_(options), hypotheses_(hypotheses) {}

  void advance(const LandmarkReading& reading, const ReadingFrame& frame,
               std::vector<std::vector<std::optional<LandmarkId>>>& decided,
               std::vector<std::vector<bool>>& founded, std::vector<std::vector<Event>>& events) {
    const auto children = bestChildren(reading);
    std::vector<RangeBearingHypothesis> next;
    std::vector<std::vector<std::optional<LandmarkId>>> next_decided;
    std::vector<std::vector<bool>> next_founded;
    std::vector<std::vector<Event>> next_events;
    next.reserve(children.size());
    for (const Child& child : children) {
      next.push_back(hypotheses_[child.parent]);
      next_events.push_back(events[child.parent]);
      next_decided.push_back(decided[child.parent]);
      next_founded.push_back(founded[child.parent]);
      next_decided.back().push_back(
          realize(child, reading, frame, next.back(), next_events.back()));
      next_founded.back().push_back(child.choice == Choice::kBirth);
      next.back().log_weight = child.log_weight;
    }
    hypotheses_ = std::move(next);
    decided = std::move(next_decided);
    founded = std::move(next_founded);
    events = std::move(next_events);
  }

 private:
  std::vector<Child> bestChildren(const LandmarkReading& reading) const {
    const double view =
        (reading.measurement.hasRange() ? options_.view_range_m : 1.0) * options_.view_angle;
    const double seen = std::log(1.0 - options_.outlier_share - options_.birth_share);
    std::vector<Child> children;
    for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
      const auto& hypothesis = hypotheses_[h];
      const double weight = hypothesis.log_weight;
      children.push_back(
          {h, Choice::kOutlier, {}, weight + std::log(options_.outlier_share / view)});
      if (hypothesis.grows() && !hypothesis.landmarkOf(reading.identity))
        children.push_back({h, Choice::kBirth, {}, weight + std::log(options_.birth_share / view)});
      for (const LandmarkId id : hypothesis.allowed(reading.identity)) {
        if (!mayBe(hypothesis.filter, id, reading.measurement)) continue;
        const auto innovation = hypothesis.filter.innovation(id, reading.measurement);
        if (innovation && innovation->within_gate)
          children.push_back(
              {h, Choice::kLandmark, id, weight + seen + logLikelihood(*innovation)});
      }
    }
    std::stable_sort(children.begin(), children.end(),
                     [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
    const double least = children.front().log_weight + kLeastLogWeight;
    std::size_t kept = 1;
    while (kept < children.size() && kept < static_cast<std::size_t>(options_.hypotheses) &&
           children[kept].log_weight >= least)
      ++kept;
    children.resize(kept);
    return children;
  }

  /// A cheap look before the innovation is computed: nothing that far off is within any gate of a
  /// map worth the name.
  bool mayBe(const EkfSlam& filter, LandmarkId id, const Measurement& measurement) const {
    constexpr double kSigmas = 8.0;
    const Block& block = *filter.state().find(id);
    if (block.block_kind != BlockKind::kPoint || !measurement.hasRange()) return true;
    const auto& P = filter.state().P;
    const double range = measurement.z(1);
    const Eigen::Vector2d p_robot =
        range * Eigen::Vector2d(std::cos(measurement.z(0)), std::sin(measurement.z(0))) +
        measurement.p_robot_camera;
    const double apart = (transform(filter.pose(), p_robot) - filter.state().values(block)).norm();
    const double spread = P(0, 0) + P(1, 1) + P(block.offset, block.offset) +
                          P(block.offset + 1, block.offset + 1) +
                          range * range * (P(2, 2) + measurement.R(0, 0)) + measurement.R(1, 1);
    return apart < kSigmas * std::sqrt(spread);
  }

  static std::optional<LandmarkId> realize(const Child& child, const LandmarkReading& reading,
                                           const ReadingFrame& frame,
                                           RangeBearingHypothesis& hypothesis,
                                           std::vector<Event>& events) {
    switch (child.choice) {
      case Choice::kBirth:
        return hypothesis.found(reading, frame, events);
      case Choice::kOutlier:
        hypothesis.filter.health().refuse("outlier");
        return std::nullopt;
      case Choice::kLandmark:
        break;
    }
    const Match match{child.landmark, reading.measurement};
    if (!hypothesis.update({&match, 1}, frame.noise_scale).front()) return std::nullopt;
    hypothesis.observe(child.landmark, reading, frame);
    return child.landmark;
  }

  const RangeBearingOptions& options_;
  std::vector<RangeBearingHypothesis>& hypotheses_;
};

}  // namespace

ReadingDecisions decideByHypotheses(const ReadingFrame& frame, const RangeBearingOptions& options,
                                    std::vector<RangeBearingHypothesis>& hypotheses) {
  std::vector<std::vector<std::optional<LandmarkId>>> decided(hypotheses.size());
  std::vector<std::vector<bool>> founded(hypotheses.size());
  std::vector<std::vector<Event>> events(hypotheses.size());
  Beam beam(options, hypotheses);
  for (const LandmarkReading& reading : frame.readings)
    beam.advance(reading, frame, decided, founded, events);
  for (std::size_t h = 0; h < hypotheses.size(); ++h) hypotheses[h].endFrame(frame, events[h]);
  const double best = hypotheses.front().log_weight;
  for (auto& hypothesis : hypotheses) hypothesis.log_weight -= best;
  return {std::move(decided), founded.front(), events.front(), false};
}

void mergeAlike(const ReadingHistories& histories,
                std::vector<RangeBearingHypothesis>& hypotheses) {
  std::set<std::uint64_t> known;
  std::erase_if(hypotheses, [&](const auto& hypothesis) {
    return !known.insert(histories.recent(hypothesis.leaf, kMemory)).second;
  });
}

}  // namespace colonnade
