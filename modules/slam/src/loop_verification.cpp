// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// How Mapper closes a loop, and takes it back when what is seen afterwards contradicts it.
#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "colonnade/base/text.hpp"
#include "colonnade/slam/mapper.hpp"

namespace colonnade {
namespace {

/// A closing is taken back when elsewhere is so much likelier than here, as a log-likelihood ratio.
/// Neighbouring looks resemble each other, so that it is worth far less than e^15.
constexpr double kMostDoubt = 15.0;
/// Old landmarks nearer than this may come into view.
constexpr double kReach_m = 8.0;
/// A way near old landmarks after which the estimate is copied anew while none of them is met.
constexpr double kCopyEvery_m = 0.5;
/// From the first old landmark met the return is recognised within this way, or there is none.
constexpr double kReturnWithin_m = 8.0;
/// A robot that stands still fills no memory: so many frames are kept to be mapped again.
constexpr std::size_t kMostFrames = 1000;

}  // namespace

void Mapper::close(const LoopCandidate& loop, const Observation& seen, std::vector<Event>& events) {
  const LoopOptions& options = options_.loops;
  Snapshot snapshot{estimate_, estimate_.landmarks.way(), {}, loop.best.shift};
  dropBearings(snapshot.estimate);
  for (const Block& block : estimate_.filter.state().blocks)
    if (estimate_.landmarks.isAsleep(block.id)) snapshot.old.insert(block.id);
  const Pose2 before = estimate_.filter.pose();
  std::vector<Event> fused;
  if (!fuseAll(loop.best.twins, {options.twin_place_m, options.twin_direction}, seen, fused))
    return;
  before_return_.reset();
  ++estimate_.closings;
  const Eigen::Vector2d moved = estimate_.filter.pose().translation() - before.translation();
  events.push_back({seen.stamp_s, seen.index, "loop closing", std::nullopt,
                    std::to_string(loop.best.twins.size()) + " landmarks at " +
                        std::to_string(loop.best.places) + " places; " + loop.cues +
                        "; the robot moved by " + formatFixed(moved.norm(), 3) + " m"});
  events.insert(events.end(), fused.begin(), fused.end());
  estimate_.landmarks.endEstrangement();
  if (!estimate_.grows || estimate_.filter.isFixed(loop.best.twins.front().kept)) settleInMap();
  if (seen.sight.rays.empty() || options.verify_m <= 0.0) return;
  estimate_.upkeep.watch(snapshot.old);
  snapshot_ = std::move(snapshot);
}

void Mapper::dropBearings(Estimate& estimate) {
  std::vector<LandmarkId> held;
  for (const Block& block : estimate.filter.state().blocks)
    if (block.evidence.hypothesis ||
        (block.block_kind == BlockKind::kPoseClone && !estimate.trail.holds(block.id)))
      held.push_back(block.id);
  for (const LandmarkId id : held) estimate.filter.remove(id);
}

/// The robot has found its place in a fixed map: what it founded on the way there goes.
void Mapper::settleInMap() {
  auto& e = estimate_;
  e.grows = false;
  e.landmarks.wakeAll();
  e.initializer = Initializer(options_.initialization);
  std::vector<LandmarkId> own;
  for (const Block& block : e.filter.state().blocks)
    if (block.block_kind != BlockKind::kAxis && !e.filter.isFixed(block.id) &&
        !e.trail.holds(block.id))
      own.push_back(block.id);
  for (const LandmarkId id : own) {
    e.filter.remove(id);
    e.landmarks.forget(id);
    e.upkeep.forget(id);
  }
}

/// The association may know old landmarks again by itself, and be as wrong about them as a
/// constellation: the estimate from before it met any of them is kept.
void Mapper::awaitReturn() {
  auto& e = estimate_;
  const double way_m = e.landmarks.way();
  if (before_return_) {
    Snapshot& before = *before_return_;
    if (!before.met && std::any_of(before.old.begin(), before.old.end(), [&](LandmarkId id) {
          return e.landmarks.seenOnWay(id).last_m > before.way_m;
        })) {
      before.met = true;
      before.way_m = way_m;
    }
    const double within_m = before.met ? kReturnWithin_m : kCopyEvery_m;
    if (way_m - before.way_m < within_m && before.since.size() < kMostFrames) return;
    before_return_.reset();
  }
  if (!e.grows || !e.loops.mayReturn(e.landmarks)) return;
  const auto isOld = [&](const Block& block) {
    return block.block_kind == BlockKind::kPoint && block.isLandmark() &&
           !e.landmarks.isEstranged(block.id) &&
           way_m - e.landmarks.seenOnWay(block.id).last_m >= LandmarkBook::kLongWay_m;
  };
  const auto& blocks = e.filter.state().blocks;
  const Eigen::Vector2d p_robot = e.filter.pose().translation();
  if (std::none_of(blocks.begin(), blocks.end(), [&](const Block& block) {
        return isOld(block) &&
               (e.filter.state().values(block).head<2>() - p_robot).norm() < kReach_m;
      }))
    return;
  std::set<LandmarkId> old;
  for (const Block& block : blocks)
    if (isOld(block)) old.insert(block.id);
  before_return_ = Snapshot{e, way_m, old, std::nullopt};
  dropBearings(before_return_->estimate);
  e.upkeep.watch(std::move(old));
}

/// Looks back on the last closing: the old landmarks it brought into view must be seen.
void Mapper::verify(const Observation& seen, std::vector<Event>& events) {
  if (estimate_.upkeep.tally().doubt > kMostDoubt)
    undo(seen, events);
  else if (estimate_.landmarks.way() - snapshot_->way_m > options_.loops.verify_m ||
           snapshot_->since.size() > kMostFrames)
    snapshot_.reset();
}

void Mapper::undo(const Observation& seen, std::vector<Event>& events) {
  const auto tally = estimate_.upkeep.tally();
  events.push_back({seen.stamp_s, seen.index, "loop closing undone", std::nullopt,
                    std::to_string(tally.seen) + " of " + std::to_string(tally.expected) +
                        " expected old landmarks seen"});
  Snapshot before = std::move(*snapshot_);
  snapshot_.reset();
  estimate_ = std::move(before.estimate);
  if (before.shift)
    estimate_.loops.forbid(*before.shift);
  else
    estimate_.landmarks.setEstranged(before.old);
  for (const Observation& again : before.since) {
    const MapperReport replayed = advance(again);
    events.insert(events.end(), replayed.events.begin(), replayed.events.end());
  }
}

}  // namespace colonnade
