// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_beam.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/gate.hpp"
#include "colonnade/filter/measurement_models.hpp"

namespace colonnade {
namespace {

/// Histories less likely than the best one by this factor (natural logarithm) are dropped.
constexpr double kLeastLogWeight = -20.0;
/// In a map that stays as it is few histories differ, and patience costs little.
constexpr double kLeastLogWeightInFixedMap = -40.0;
/// Decisions after which two histories that agree are one.
constexpr int kMemory = 60;
/// Nothing farther off than this is within any gate of a map worth the name.
constexpr double kFirstLook2 = 16.0;
/// In a map that stays as it is a history is a pose: one that a likelier one agrees with to so many
/// squared deviations of its own goes.
constexpr double kAlike2 = 0.5;

enum class Choice { kLandmark, kBirth, kOutlier };

struct Child {
  std::size_t parent = 0;
  Choice choice = Choice::kOutlier;
  LandmarkId landmark{};
  double log_weight = 0.0;
};

/// What a history says of the robot.
struct PoseEstimate {
  Pose2 mean;
  Eigen::Matrix3d covariance;
};

bool agrees(const PoseEstimate& estimate, const PoseEstimate& with) {
  const Eigen::LLT<Eigen::Matrix3d> llt(estimate.covariance);
  if (llt.info() != Eigen::Success) return false;
  const Eigen::Vector3d apart(estimate.mean.x - with.mean.x, estimate.mean.y - with.mean.y,
                              wrapAngle(estimate.mean.phi - with.mean.phi));
  return apart.dot(llt.solve(apart)) < kAlike2;
}

/// What a reading of a landmark would make of the robot.
PoseEstimate poseAfter(const EkfSlam& filter, LandmarkId landmark, const Measurement& measurement,
                       double noise_scale) {
  const State& state = filter.state();
  const Block& block = *state.find(landmark);
  const auto predicted =
      predictMeasurement(filter.pose(), block.block_kind, state.values(block), measurement);
  const Eigen::Matrix3d P = filter.poseCovariance();
  const Eigen::MatrixXd P_block = state.P.block(0, block.offset, 3, block.size());
  const Eigen::MatrixXd PHt =
      P * predicted.H_robot.transpose() + P_block * predicted.H_block.transpose();
  const Eigen::MatrixXd S =
      filter.innovation(landmark, measurement)->S + (noise_scale - 1.0) * noiseOf(measurement);
  const Eigen::MatrixXd K = S.llt().solve(PHt.transpose()).transpose();
  const Eigen::Vector3d dx = K * innovationOf(measurement, predicted.z);
  const Pose2 mean = filter.pose();
  return {{mean.x + dx.x(), mean.y + dx.y(), wrapAngle(mean.phi + dx.z())},
          P - K * PHt.transpose()};
}

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
    const auto children = bestChildren(reading, frame.noise_scale);
    std::vector<std::size_t> heirs(hypotheses_.size(), 0);
    for (const Child& child : children) ++heirs[child.parent];
    std::vector<RangeBearingHypothesis> next;
    std::vector<std::vector<std::optional<LandmarkId>>> next_decided;
    std::vector<std::vector<bool>> next_founded;
    std::vector<std::vector<Event>> next_events;
    next.reserve(children.size());
    for (const Child& child : children) {
      auto& parent = hypotheses_[child.parent];
      next.push_back(--heirs[child.parent] > 0 ? parent : std::move(parent));
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
  std::vector<Child> bestChildren(const LandmarkReading& reading, double noise_scale) const {
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
        if (!hypothesis.filter.mayBeWithin(id, reading.measurement, kFirstLook2)) continue;
        const auto innovation = hypothesis.filter.innovation(id, reading.measurement);
        if (innovation && innovation->within_gate)
          children.push_back(
              {h, Choice::kLandmark, id, weight + seen + logLikelihood(*innovation)});
      }
    }
    std::stable_sort(children.begin(), children.end(),
                     [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
    const double least =
        children.front().log_weight +
        (hypotheses_.front().grows() ? kLeastLogWeight : kLeastLogWeightInFixedMap);
    std::vector<Child> best;
    std::vector<PoseEstimate> said;
    for (const Child& child : children) {
      if (best.size() == static_cast<std::size_t>(options_.hypotheses) || child.log_weight < least)
        break;
      if (!hypotheses_[child.parent].grows()) {
        const PoseEstimate says = poseOf(child, reading, noise_scale);
        if (std::any_of(said.begin(), said.end(),
                        [&](const auto& likelier) { return agrees(says, likelier); }))
          continue;
        said.push_back(says);
      }
      best.push_back(child);
    }
    return best;
  }

  PoseEstimate poseOf(const Child& child, const LandmarkReading& reading,
                      double noise_scale) const {
    const EkfSlam& filter = hypotheses_[child.parent].filter;
    if (child.choice == Choice::kLandmark)
      return poseAfter(filter, child.landmark, reading.measurement, noise_scale);
    return {filter.pose(), filter.poseCovariance()};
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
