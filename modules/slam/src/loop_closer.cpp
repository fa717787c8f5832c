// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/loop_closer.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kYoungTrail_m = 3.0;      ///< of the way just driven that is no former one
constexpr double kOnTrail_m = 1.5;         ///< from a pose of the trail
constexpr double kAfterNewGround_m = 4.0;  ///< way within which a return is recognised
constexpr double kSamePlace_m = 0.10;
constexpr double kFoundTwice_m = 0.08;  ///< what was found twice stands no farther apart

/// Whether another landmark of its kind and looks stands so near that it may be taken for it.
/// Floor edges run along each other everywhere: they always have one.
bool hasDouble(const Block& block, double near_m, const State& state, const LandmarkBook& book) {
  if (block.block_kind != BlockKind::kPoint) return true;
  const Eigen::Vector2d p = state.values(block);
  return std::any_of(state.blocks.begin(), state.blocks.end(), [&](const Block& other) {
    return other.id != block.id && other.block_kind == BlockKind::kPoint &&
           other.landmark_kind == block.landmark_kind &&
           (state.x.segment<2>(other.offset) - p).norm() < near_m &&
           book.lookAlike(block.id, other.id, state);
  });
}

/// Whether one of the others stands where this one might; what is no point might be anywhere.
bool hasNear(LandmarkId id, const std::vector<LandmarkId>& others, const State& state) {
  constexpr double kReach_m = 0.3;
  const Block& block = *state.find(id);
  if (block.block_kind != BlockKind::kPoint) return true;
  const Eigen::Vector2d p = state.x.segment<2>(block.offset);
  return std::any_of(others.begin(), others.end(), [&](LandmarkId other_id) {
    const Block& other = *state.find(other_id);
    return other.landmark_kind == block.landmark_kind &&
           (other.block_kind != BlockKind::kPoint ||
            (state.x.segment<2>(other.offset) - p).norm() < kReach_m);
  });
}

/// Of a robot that the filter is right about, however many places it sees: nothing has drifted that
/// the filter does not know of, but nothing else may fit either.
LoopOptions sureOfPlace(LoopOptions options) {
  options.min_places = 1;
  options.min_spread_m = options.drift_share = options.drift_turn = 0.0;
  options.twin_place_m = TwinNoise{}.place_m;
  options.twin_direction = TwinNoise{}.direction;
  options.joint_probability = 0.9;
  options.distinct_m = 0.04;  // edges of one frame are distinct
  options.ambiguity = 0.8;
  return options;
}

}  // namespace

double relativeSigma(LandmarkId landmark, const EkfSlam& filter) {
  const Block& block = *filter.state().find(landmark);
  const Pose2 robot = filter.pose();
  const Eigen::Matrix2d Rt = robot.rotation().transpose();
  const Eigen::Vector2d v = Rt * (filter.state().values(block).head<2>() - robot.translation());
  Eigen::Matrix<double, 2, 3> J_robot;
  J_robot << -Rt, Eigen::Vector2d(v.y(), -v.x());
  SparseJacobian H(2);
  H.add(0, 0, J_robot).add(0, block.offset, Rt);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(
      Eigen::Matrix2d(filter.covarianceOf(H)), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()(1)));
}

void LoopCloser::updateSleep(const EkfSlam& filter, LandmarkBook& book) {
  if (book.way() - sleep_checked_m_ < options_.try_every_m) return;
  sleep_checked_m_ = book.way();
  for (const Block& block : filter.state().blocks) {
    if (!block.isLandmark() || book.isEstranged(block.id)) continue;
    // What no closing would wake: a fixed map is for the association then.
    if (!options_.enabled && filter.isFixed(block.id)) continue;
    const bool long_ago = book.way() - book.seenOnWay(block.id).last_m > options_.sleep_after_m;
    if (!long_ago && !book.isAsleep(block.id)) continue;
    const double sigma = relativeSigma(block.id, filter);
    book.setAsleep(block.id, sigma > options_.sleep_sigma_alone_m ||
                                 (sigma > options_.sleep_sigma_m &&
                                  hasDouble(block, 4.0 * sigma, filter.state(), book)));
  }
}

bool LoopCloser::isComparable(const Block& block, const LandmarkBook& book) const {
  return block.isLandmark() && !block.evidence.hypothesis && !book.isJoint(block.id) &&
         block.evidence.observations >= options_.min_observations;
}

std::optional<LoopCandidate> LoopCloser::step(const EkfSlam& filter, const LandmarkBook& book) {
  if (!options_.enabled || book.way() - searched_m_ < options_.try_every_m) return std::nullopt;
  searched_m_ = book.way();
  std::vector<LandmarkId> sleeping, recent;
  for (const Block& block : filter.state().blocks) {
    if (!isComparable(block, book)) continue;
    if (book.isAsleep(block.id))
      sleeping.push_back(block.id);
    else if (!filter.isFixed(block.id) &&
             book.way() - book.seenOnWay(block.id).last_m < options_.recent_m)
      recent.push_back(block.id);
  }
  last_ = findConstellation(sleeping, recent, filter, book, options_);
  if (last_.refusal.empty() && last_.cues.empty()) last_.refusal = "no second cue";
  const auto isSame = [&](const Eigen::Vector2d& shift) {
    return (shift - last_.best.shift).norm() < options_.distinct_m;
  };
  if (last_.refusal.empty() && std::any_of(forbidden_.begin(), forbidden_.end(), isSame))
    last_.refusal = "turned out wrong before";
  if (!last_.refusal.empty()) {
    confirmed_ = 0;
    return std::nullopt;
  }
  confirmed_ = confirmed_ > 0 && isSame(confirmed_shift_) ? confirmed_ + 1 : 1;
  confirmed_shift_ = last_.best.shift;
  if (confirmed_ < options_.confirmations) return std::nullopt;
  confirmed_ = 0;
  returned_ = true;
  return last_;
}

std::vector<Twins> LoopCloser::foundTwice(const EkfSlam& filter, const LandmarkBook& book) const {
  if (!options_.enabled) return {};
  std::vector<LandmarkId> old, young;
  for (const Block& block : filter.state().blocks) {
    if (!isComparable(block, book) || book.isEstranged(block.id) || filter.isFixed(block.id))
      continue;
    const bool is_young = !book.isAsleep(block.id) &&
                          book.way() - book.seenOnWay(block.id).first_m < options_.recent_m;
    if (is_young)
      young.push_back(block.id);
    else if (relativeSigma(block.id, filter) < options_.sleep_sigma_alone_m)
      old.push_back(block.id);
  }
  std::erase_if(old, [&](LandmarkId id) { return !hasNear(id, young, filter.state()); });
  const LoopCandidate found = findConstellation(old, young, filter, book, sureOfPlace(options_));
  const bool stands = found.refusal.empty() && found.best.largest_shift_m < kFoundTwice_m;
  return stands ? found.best.twins : std::vector<Twins>{};
}

bool LoopCloser::mayReturn(const LandmarkBook& book) const {
  return options_.enabled && !returned_ && book.way() - new_ground_m_ <= kAfterNewGround_m;
}

int LoopCloser::stepReturn(const EkfSlam& filter, const LandmarkBook& book, const Trail& trail) {
  if (!options_.enabled) return 0;
  if (trail.distanceToFormer(filter, kYoungTrail_m) > kOnTrail_m) {
    new_ground_m_ = book.way();
    returned_ = false;
    return 0;
  }
  if (!mayReturn(book)) return 0;
  std::vector<Eigen::Vector2d> places;
  for (const Block& block : filter.state().blocks) {
    if (block.block_kind != BlockKind::kPoint) continue;
    const auto seen = book.seenOnWay(block.id);
    if (!seen.returned_m || *seen.returned_m < new_ground_m_ - kAfterNewGround_m) continue;
    const Eigen::Vector2d p = filter.state().values(block);
    if (std::none_of(places.begin(), places.end(),
                     [&](const auto& q) { return (p - q).norm() < kSamePlace_m; }))
      places.push_back(p);
  }
  if (static_cast<int>(places.size()) < options_.min_places) return 0;
  returned_ = true;
  return static_cast<int>(places.size());
}

}  // namespace colonnade
