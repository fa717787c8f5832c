// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_alike.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

namespace colonnade {
namespace {

/// Decisions after which two histories that agree are one.
constexpr int kDecisionsCompared = 60;
constexpr double kSurest_m = 1e-5;

/// A landmark that rests, as the robot has it, by where it was at the last exchange.
struct Resting {
  LandmarkId id{};
  std::optional<int> identity;
  Eigen::Vector2d p_robot;
  double spread2;  ///< sum of both variances, in the world

  /// Each history hands out its own ids: the same one may be another thing in another place.
  bool agrees(const Resting& likelier) const {
    return id == likelier.id && identity == likelier.identity &&
           (p_robot - likelier.p_robot).squaredNorm() < kAlike2 * (spread2 + kSurest_m * kSurest_m);
  }
};

/// What a history expects: each landmark where it lies before the robot. Where the robot, and all
/// of the map with it, is in the world does not matter, and how unsure that is hides no difference,
/// but for landmarks that rest: these were compared so while they were active.
class Expectation {
 public:
  explicit Expectation(const RangeBearingHypothesis& history) {
    std::vector<double> last_seen_s;
    for (const Block& block : history.filter.state().blocks) {
      if (block.block_kind == BlockKind::kSensor) continue;
      comparable_ = comparable_ && block.block_kind == BlockKind::kPoint;
      if (!comparable_) break;
      outlooks_.push_back(outlookOf(history, block));
      last_seen_s.push_back(block.evidence.last_stamp_s);
    }
    const RestingMap& resting = history.filter.resting();
    const Pose2 T_robot_world = history.filter.pose().inverse();
    for (const Block& block : resting.blocks())
      resting_.push_back({block.id, history.identityOf(block.id),
                          transform(T_robot_world, resting.valueThen(block).head<2>()),
                          resting.spread2(block)});
    order_.resize(outlooks_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return last_seen_s[a] > last_seen_s[b]; });
  }

  /// Whether each of its landmarks is one of the other's, as near as this history is sure of.
  bool agrees(const Expectation& likelier) const {
    if (!comparable_ || !likelier.comparable_ || outlooks_.size() != likelier.outlooks_.size())
      return false;
    std::vector<bool> taken(outlooks_.size(), false);
    const auto isAt = [&](std::size_t i, std::size_t place) {
      return !taken[place] && outlooks_[i].agrees(likelier.outlooks_[place]);
    };
    for (const std::size_t i : order_) {
      std::size_t place = i;  // as a rule the two share most of their past
      if (!isAt(i, place))
        for (place = 0; place < taken.size() && !isAt(i, place);) ++place;
      if (place == taken.size()) return false;
      taken[place] = true;
    }
    return std::equal(resting_.begin(), resting_.end(), likelier.resting_.begin(),
                      likelier.resting_.end(),
                      [](const Resting& a, const Resting& b) { return a.agrees(b); });
  }

 private:
  bool comparable_ = true;  ///< all active landmarks are points
  std::vector<Outlook> outlooks_;
  std::vector<std::size_t> order_;  ///< last seen first: there histories differ most often
  std::vector<Resting> resting_;
};

}  // namespace

bool Outlook::agrees(const Outlook& likelier) const {
  const Eigen::Vector2d apart = p_robot - likelier.p_robot;
  const double ratio2 = kFarLessSure * kFarLessSure;
  return identity == likelier.identity && apart.dot(covariance.inverse() * apart) < kAlike2 &&
         covariance.determinant() < ratio2 * ratio2 * likelier.covariance.determinant();
}

/// p = R^T (l - t): its derivative by the heading is p turned clockwise.
Outlook outlookOf(const RangeBearingHypothesis& history, const Block& block) {
  const State& state = history.filter.state();
  const Pose2 T_robot_world = state.T_world_robot().inverse();
  const Eigen::Matrix2d R = T_robot_world.rotation();
  const Eigen::Vector2d p = transform(T_robot_world, state.x.segment<2>(block.offset));
  Eigen::Matrix<double, 2, 3> J_robot;
  J_robot << -R, Eigen::Vector2d(p.y(), -p.x());
  const Eigen::Matrix2d mixed = J_robot * state.P.block<3, 2>(0, block.offset) * R.transpose();
  const Eigen::Matrix2d C = J_robot * state.P.topLeftCorner<3, 3>() * J_robot.transpose() + mixed +
                            mixed.transpose() +
                            R * state.P.block<2, 2>(block.offset, block.offset) * R.transpose();
  return {p, C + kSurest_m * kSurest_m * Eigen::Matrix2d::Identity(), history.identityOf(block.id)};
}

void mergeAlike(const ReadingHistories& histories,
                std::vector<RangeBearingHypothesis>& hypotheses) {
  std::set<std::uint64_t> known;
  std::erase_if(hypotheses, [&](const auto& hypothesis) {
    return !known.insert(histories.recent(hypothesis.leaf, kDecisionsCompared)).second;
  });
  if (!hypotheses.front().grows()) return;
  std::vector<Expectation> expectations;
  std::vector<RangeBearingHypothesis> kept;
  for (RangeBearingHypothesis& hypothesis : hypotheses) {
    Expectation expectation(hypothesis);
    if (std::any_of(expectations.begin(), expectations.end(),
                    [&](const auto& likelier) { return expectation.agrees(likelier); }))
      continue;
    expectations.push_back(std::move(expectation));
    kept.push_back(std::move(hypothesis));
  }
  hypotheses = std::move(kept);
}

}  // namespace colonnade
