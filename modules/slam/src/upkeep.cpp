// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/upkeep.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

constexpr double kMargin = radians(3.0);  ///< from the border of the picture
constexpr double kBeside = radians(1.5);  ///< rays about a landmark that must reach it
constexpr double kInFront_m = 0.15;
/// A look counts when it shows this share of what it should, and should show so many.
constexpr double kClearShare = 0.4;
constexpr int kClearCount = 3;
/// Log-odds of one miss at most: ten looks may fail for one common reason.
constexpr double kWorstMiss = 1.0;
/// From elsewhere something else is taken for a landmark so many times as often as the landmark
/// itself is seen from here.
constexpr double kMistaken = 0.5;
/// What one look may add to the doubt.
constexpr double kMostDoubt = 4.0;

}  // namespace

bool isInView(const Eigen::Vector2d& p_world, const Pose2& T_world_robot, const Sight& sight) {
  if (sight.rays.empty()) return false;
  const Eigen::Vector2d v = transform(T_world_robot.inverse(), p_world) - sight.p_robot_camera;
  const double bearing = std::atan2(v.y(), v.x()), range = v.norm();
  if (bearing < sight.rays.front().bearing + kMargin ||
      bearing > sight.rays.back().bearing - kMargin)
    return false;
  auto ray = std::lower_bound(sight.rays.begin(), sight.rays.end(), bearing - kBeside,
                              [](const Sight::Ray& r, double b) { return r.bearing < b; });
  int measured = 0;
  for (; ray != sight.rays.end() && ray->bearing <= bearing + kBeside; ++ray) {
    if (ray->range_m <= 0.0) continue;
    if (ray->range_m < range - kInFront_m) return false;
    ++measured;
  }
  return measured > 0;
}

std::vector<LandmarkId> Upkeep::findGone(const Observation& seen,
                                         const std::vector<LandmarkId>& matched,
                                         const EkfSlam& filter, const LandmarkBook& book) {
  std::vector<LandmarkId> gone;
  look_ended_ = false;
  ++frames_;
  const Pose2 pose = filter.pose();
  const Eigen::Vector2d p_camera = transform(pose, seen.sight.p_robot_camera);
  for (const Block& block : filter.state().blocks) {
    if (!block.isLandmark() || block.block_kind != BlockKind::kPoint || book.isAsleep(block.id))
      continue;
    const Eigen::Vector2d p = filter.state().values(block);
    const double range = (p - p_camera).norm();
    if (std::binary_search(matched.begin(), matched.end(), block.id)) {
      Record& record = records_[block.id];
      record.nearest_m = std::min(record.nearest_m, range);
      record.farthest_m = std::max(record.farthest_m, range);
      record.hit = true;
      ++record.frames_expected;
      continue;
    }
    const auto known = records_.find(block.id);
    if (known == records_.end() || range < known->second.nearest_m ||
        range > 0.9 * known->second.farthest_m || !isInView(p, pose, seen.sight))
      continue;
    ++known->second.frames_expected;
  }
  const Pose2 moved = T_world_look_ ? T_world_look_->inverse() * pose : Pose2{};
  if (!T_world_look_) T_world_look_ = pose;
  if (moved.translation().norm() < options_.look_distance_m &&
      std::abs(moved.phi) < options_.look_turn)
    return gone;
  endLook(gone);
  look_ended_ = true;
  frames_ = 0;
  T_world_look_ = pose;
  std::erase_if(gone, [&](LandmarkId id) { return filter.isFixed(id); });
  return gone;
}

double Upkeep::Record::share() const {
  return std::clamp((hits + 2.0) / (looks + 3.0), 0.15, 0.95);
}

double Upkeep::weigh(const Record& watched) {
  const double here = watched.share(), elsewhere = kMistaken * here;
  ++tally_.expected;
  tally_.seen += watched.hit ? 1 : 0;
  return std::log(watched.hit ? elsewhere / here : (1.0 - elsewhere) / (1.0 - here));
}

void Upkeep::endLook(std::vector<LandmarkId>& gone) {
  int expected = 0, hits = 0;
  double doubt = 0.0;
  const auto counts = [&](const Record& r) { return 2 * r.frames_expected >= frames_ || r.hit; };
  for (const auto& [id, record] : records_) {
    if (!counts(record)) continue;
    ++expected;
    hits += record.hit ? 1 : 0;
    if (watched_.contains(id)) doubt += weigh(record);
  }
  // Who sees nothing at all is in the dark, not elsewhere.
  if (hits > 0) tally_.doubt = std::max(0.0, tally_.doubt + std::min(doubt, kMostDoubt));
  const bool clear = expected >= kClearCount && hits >= kClearShare * expected;
  for (auto& [id, record] : records_) {
    if (clear && counts(record)) {
      ++record.looks;
      record.hits += record.hit ? 1 : 0;
      const double share = record.share();
      const double by_hit = std::log(share / options_.false_sighting);
      const double by_miss = std::log((1.0 - share) / (1.0 - options_.false_sighting));
      record.evidence += record.hit ? std::max(0.0, by_hit) : std::clamp(by_miss, -kWorstMiss, 0.0);
      record.evidence = std::min(record.evidence, options_.most_evidence);
      if (options_.remove_gone && record.evidence < options_.gone_evidence) gone.push_back(id);
    }
    record.frames_expected = 0;
    record.hit = false;
  }
}

std::vector<Twins> Upkeep::findTwins(const EkfSlam& filter, const LandmarkBook& book) const {
  std::vector<Twins> found;
  if (!options_.merge_twins) return found;
  const State& state = filter.state();
  const double gate = chiSquareQuantile(options_.merge_probability, 2);
  std::set<LandmarkId> used;
  for (std::size_t i = 0; i < state.blocks.size(); ++i) {
    const Block& kept = state.blocks[i];
    if (kept.block_kind != BlockKind::kPoint || book.isAsleep(kept.id)) continue;
    for (std::size_t k = i + 1; k < state.blocks.size(); ++k) {
      const Block& twin = state.blocks[k];
      if (twin.block_kind != BlockKind::kPoint || twin.landmark_kind != kept.landmark_kind ||
          (state.values(twin) - state.values(kept)).norm() > options_.merge_distance_m ||
          book.isAsleep(twin.id) || book.seenTogether(kept.id, twin.id) ||
          !book.lookAlike(kept.id, twin.id, state) || used.contains(kept.id) ||
          used.contains(twin.id) || filter.isFixed(twin.id))
        continue;
      const auto d = differenceOf(state, {kept.id, twin.id});
      if (!d) continue;
      const Eigen::Matrix2d C =
          filter.covarianceOf(stacked({&*d, 1})) + TwinNoise{}.covariance(false);
      // Places that are themselves unknown prove nothing.
      if (C.trace() > options_.merge_distance_m * options_.merge_distance_m) continue;
      if (d->difference.dot(C.ldlt().solve(d->difference)) > gate) continue;
      found.push_back({kept.id, twin.id});
      used.insert(kept.id);
      used.insert(twin.id);
    }
  }
  return found;
}

}  // namespace colonnade
