// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_beam.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/gate.hpp"
#include "range_bearing_alike.hpp"

namespace colonnade {
namespace {

/// Histories less likely than the best one by this factor (natural logarithm) are dropped.
constexpr double kLeastLogWeight = -20.0;
/// In a map that stays as it is few histories differ, and patience costs little.
constexpr double kLeastLogWeightInFixedMap = -40.0;
/// The states of all histories, and so many at least.
constexpr std::size_t kStates_bytes = std::size_t{1} << 29;
constexpr std::size_t kFewest = 4;
/// In a map that grows, states that take no more than this are cheap: of up to 50 landmarks.
constexpr std::size_t kCheap_bytes = std::size_t{1} << 23;

enum class Choice { kLandmark, kBirth, kOutlier };

struct Child {
  std::size_t parent = 0;
  Choice choice = Choice::kOutlier;
  LandmarkId landmark{};
  double log_weight = 0.0;
};

/// What a history says in a map that stays as it is: where the robot is, and, as long as its frame
/// is not over, which landmarks readings to come can no longer be of, though they might.
struct Account {
  RobotEstimate robot;
  std::vector<LandmarkId> taken;  ///< ascending
};

bool agrees(const Account& account, const Account& likelier) {
  const auto& [pose, covariance] = account.robot;
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  if (account.taken != likelier.taken || llt.info() != Eigen::Success) return false;
  const Pose2& other = likelier.robot.T_world_robot;
  const Eigen::Vector3d apart(pose.x - other.x, pose.y - other.y, wrapAngle(pose.phi - other.phi));
  return apart.dot(llt.solve(apart)) < kAlike2 &&
         covariance.determinant() <
             std::pow(kFarLessSure, 6) * likelier.robot.covariance.determinant();
}

/// In a map that stays as it is, three times as many, since all of them differ; in one that grows,
/// as long as it is small, up to two and a half times as many, since they cost little; of large
/// states not more than fit into the memory meant for them, though always some.
std::size_t mostOf(const RangeBearingHypothesis& hypothesis, const RangeBearingOptions& options) {
  const auto wanted = static_cast<std::size_t>(std::max(1, options.hypotheses));
  const auto bytes = static_cast<std::size_t>(hypothesis.filter.state().P.size()) * sizeof(double);
  const bool small = wanted > 1 && hypothesis.filter.resting().blocks().empty();
  const std::size_t cheap =
      small ? std::clamp(kCheap_bytes / bytes, wanted, 5 * wanted / 2) : wanted;
  const std::size_t room = std::max(kFewest, kStates_bytes / bytes);
  return std::min(hypothesis.grows() ? cheap : 3 * wanted, room);
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

  /// By the first of these readings of a frame; the others are still to come.
  void advance(std::span<const LandmarkReading> readings, const ReadingFrame& frame,
               std::vector<std::vector<std::optional<LandmarkId>>>& decided,
               std::vector<std::vector<bool>>& founded, std::vector<std::vector<Event>>& events) {
    const LandmarkReading& reading = readings.front();
    const auto children = bestChildren(readings, frame.noise_scale);
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
  std::vector<Child> bestChildren(std::span<const LandmarkReading> readings,
                                  double noise_scale) const {
    const LandmarkReading& reading = readings.front();
    const double view = options_.viewFor(reading.measurement);
    const double seen = std::log(1.0 - options_.outlier_share - options_.birth_share);
    const double gate = gateOf(reading.measurement);
    std::vector<Child> children;
    for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
      const auto& hypothesis = hypotheses_[h];
      const double weight = hypothesis.log_weight;
      children.push_back(
          {h, Choice::kOutlier, {}, weight + std::log(options_.outlier_share / view)});
      if (hypothesis.grows() && !hypothesis.landmarkOf(reading.identity))
        children.push_back({h, Choice::kBirth, {}, weight + std::log(options_.birth_share / view)});
      for (const LandmarkId id : hypothesis.allowed(reading.identity)) {
        if (!hypothesis.filter.mayBeWithin(id, reading.measurement, gate)) continue;
        const auto innovation = hypothesis.filter.innovation(id, reading.measurement);
        if (innovation && innovation->within_gate)
          children.push_back(
              {h, Choice::kLandmark, id, weight + seen + logLikelihood(*innovation)});
      }
    }
    std::stable_sort(children.begin(), children.end(),
                     [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
    return kept(children, readings, noise_scale);
  }

  /// Of children, likeliest first: not too many, none too unlikely, and in a map that stays as it
  /// is none that says what a likelier one says.
  std::vector<Child> kept(const std::vector<Child>& children,
                          std::span<const LandmarkReading> readings, double noise_scale) const {
    const bool fixed = !hypotheses_.front().grows();
    const std::size_t most = mostOf(hypotheses_.front(), options_);
    const double least =
        children.front().log_weight + (fixed ? kLeastLogWeightInFixedMap : kLeastLogWeight);
    std::vector<Child> kept;
    std::vector<Account> accounts;
    for (const Child& child : children) {
      if (child.log_weight < least) break;
      if (fixed) {
        Account account = accountOf(child, readings, noise_scale);
        if (std::any_of(accounts.begin(), accounts.end(),
                        [&](const Account& likelier) { return agrees(account, likelier); }))
          continue;
        accounts.push_back(std::move(account));
      }
      kept.push_back(child);
      if (kept.size() >= most) break;
    }
    return kept;
  }

  /// The squared distance at which any history's filter refuses a measurement.
  double gateOf(const Measurement& measurement) const {
    return chiSquareQuantile(hypotheses_.front().filter.options().gate_probability,
                             static_cast<int>(measurement.z.size()));
  }

  Account accountOf(const Child& child, std::span<const LandmarkReading> readings,
                    double noise_scale) const {
    const RangeBearingHypothesis& parent = hypotheses_[child.parent];
    Account account{{parent.filter.pose(), parent.filter.poseCovariance()}, parent.used};
    if (child.choice == Choice::kLandmark) {
      account.robot =
          parent.filter.robotAfter({child.landmark, readings.front().measurement}, noise_scale);
      account.taken.push_back(child.landmark);
    }
    std::erase_if(account.taken, [&](const LandmarkId id) {
      return std::none_of(readings.begin() + 1, readings.end(), [&](const auto& later) {
        return parent.filter.mayBeWithin(id, later.measurement, gateOf(later.measurement));
      });
    });
    std::sort(account.taken.begin(), account.taken.end());
    return account;
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
  const std::span<const LandmarkReading> readings(frame.readings);
  for (std::size_t i = 0; i < readings.size(); ++i)
    beam.advance(readings.subspan(i), frame, decided, founded, events);
  for (std::size_t h = 0; h < hypotheses.size(); ++h) hypotheses[h].endFrame(frame, events[h]);
  const double best = hypotheses.front().log_weight;
  for (auto& hypothesis : hypotheses) hypothesis.log_weight -= best;
  return {std::move(decided), founded.front(), events.front(), false};
}

}  // namespace colonnade
