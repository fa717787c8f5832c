// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/filter/gate.hpp"
#include "first_look.hpp"
#include "sensed.hpp"

namespace colonnade {
namespace {

/// Share of right measurements whose landmark is found among the resting ones.
constexpr double kNearProbability = 0.9999;
constexpr double kFarthestInverseDepth = 1e-3;
/// What is active lies along the way ahead: what the robot sees next is there, and landmarks are
/// exchanged half as often as with the nearest ones. As long as so many times the radius in which
/// as many would lie around the robot; what is wider is left out for it.
constexpr double kAhead = 1.0;

/// From one end to the other; a point has both ends in one place.
struct Segment {
  Eigen::Vector2d from;
  Eigen::Vector2d to;

  double distanceTo(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d way = to - from;
    const double length2 = way.squaredNorm();
    const double share = length2 > 0.0 ? std::clamp((p - from).dot(way) / length2, 0.0, 1.0) : 0.0;
    return (p - from - share * way).norm();
  }
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool haveCrossed(const Segment& a, const Segment& b) {
  const auto onBothSides = [](const Segment& line, const Segment& of) {
    const Eigen::Vector2d way = line.to - line.from;
    return cross(way, of.from - line.from) * cross(way, of.to - line.from) < 0.0;
  };
  return onBothSides(a, b) && onBothSides(b, a);
}

double distanceBetween(const Segment& a, const Segment& b) {
  if (haveCrossed(a, b)) return 0.0;
  return std::min(
      {a.distanceTo(b.from), a.distanceTo(b.to), b.distanceTo(a.from), b.distanceTo(a.to)});
}

/// Where a landmark is; of a floor edge the part that was seen.
Segment extentOf(const Block& block, const BlockVector& y) {
  switch (block.block_kind) {
    case BlockKind::kFloorLine: {
      const Eigen::Vector2d m(std::cos(y(2)), std::sin(y(2))), along(-m.y(), m.x());
      const Eigen::Vector2d foot = y.head<2>() + y(3) * m;
      return {foot + block.evidence.along_min_m * along, foot + block.evidence.along_max_m * along};
    }
    case BlockKind::kInverseDepth: {
      const Eigen::Vector2d p =
          y(3) > kFarthestInverseDepth ? pointOf(y) : Eigen::Vector2d(y.head<2>());
      return {p, p};
    }
    default:
      return {y.head<2>(), y.head<2>()};
  }
}

struct Place {
  const Block* block;
  BlockVector y;
  double distance = 0.0;
};

/// The `count` nearest come first; returns the distance of the farthest of them.
double nearest(std::vector<Place>& places, std::size_t count, const Segment& way) {
  for (Place& place : places)
    place.distance = distanceBetween(way, extentOf(*place.block, place.y));
  if (count == 0) return 0.0;
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count - 1),
                   places.end(), [](const Place& a, const Place& b) {
                     return std::pair(a.distance, a.block->id) < std::pair(b.distance, b.block->id);
                   });
  return places[count - 1].distance;
}

/// A measurement with range.
struct Sighting {
  const Measurement* measurement;
  FirstLook look;
};

std::vector<Sighting> sightings(std::span<const Measurement> measurements, const State& state) {
  const Eigen::Matrix3d P_robot = state.P.topLeftCorner<3, 3>();
  std::vector<Sighting> sightings;
  for (const Measurement& m : measurements) {
    if (!m.hasRange() || m.kind == LandmarkKind::kFloorEdge) continue;
    if (!m.z.allFinite() || !m.R.allFinite()) continue;
    sightings.push_back({&m, {state.T_world_robot(), P_robot, seenWith(state, m)}});
  }
  return sightings;
}

}  // namespace

void EkfSlam::focus(std::span<const LandmarkId> needed, std::span<const Measurement> open) {
  if (options_.active_landmarks <= 0 || fixed_ > 0) return;
  const auto isChoosable = [](const Block& b) { return b.isLandmark() && !b.evidence.hypothesis; };
  const auto most = static_cast<std::ptrdiff_t>(options_.active_landmarks);
  const auto woken = restingNear(open);
  const bool wakes = !woken.empty() || std::any_of(needed.begin(), needed.end(),
                                                   [&](LandmarkId id) { return isResting(id); });
  if (!wakes && std::count_if(state_.blocks.begin(), state_.blocks.end(), isChoosable) <= 2 * most)
    return;

  std::vector<LandmarkId> active = woken;
  for (const LandmarkId id : activeNear(open)) active.push_back(id);
  std::vector<Place> places;
  for (const Block& block : state_.blocks) {
    if (isChoosable(block))
      places.push_back({&block, state_.values(block)});
    else
      active.push_back(block.id);
  }
  // Where resting landmarks were at the last exchange is good enough to choose by.
  for (const Block& block : resting_.blocks())
    places.push_back({&block, resting_.valueThen(block)});
  const auto count = std::min<std::size_t>(places.size(), options_.active_landmarks);
  const Eigen::Vector2d p_robot = pose().translation();
  const double radius = nearest(places, count, {p_robot, p_robot});
  nearest(places, count, {p_robot, transform(pose(), Eigen::Vector2d(kAhead * radius, 0.0))});
  for (std::size_t i = 0; i < count; ++i) active.push_back(places[i].block->id);
  for (const LandmarkId id : needed)
    if (state_.find(id) || isResting(id)) active.push_back(id);
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  resting_.exchange(state_, active, options_.invariant, options_.negligible_gain);
}

std::vector<LandmarkId> EkfSlam::activeNear(std::span<const Measurement> measurements) const {
  std::vector<LandmarkId> near;
  const auto seen = sightings(measurements, state_);
  const double bound = chiSquareQuantile(kNearProbability, 2);
  const auto mayBe = [&](const Block& block, const Measurement& m) {
    const auto predicted = innovation(block.id, m);
    return !predicted || predicted->distance2 <= bound;
  };
  for (const Block& block : state_.blocks) {
    if (block.block_kind != BlockKind::kPoint) continue;
    const Eigen::Vector2d p = state_.values(block);
    const double spread2 = state_.P.diagonal().segment<2>(block.offset).sum();
    if (std::any_of(seen.begin(), seen.end(), [&](const Sighting& sighting) {
          return sighting.measurement->kind == block.landmark_kind &&
                 !sighting.look.rulesOut(p, spread2, bound) && mayBe(block, *sighting.measurement);
        }))
      near.push_back(block.id);
  }
  return near;
}

std::vector<LandmarkId> EkfSlam::restingNear(std::span<const Measurement> measurements) const {
  std::vector<LandmarkId> near;
  const auto seen = sightings(measurements, state_);
  if (resting_.empty() || seen.empty()) return near;
  const double bound = chiSquareQuantile(kNearProbability, 2);
  const double move = resting_.largestMove(state_);
  // A reading speaks of the landmark and of these rows of the state: robot and sensor.
  std::vector<Eigen::Index> own{0, 1, 2};
  const Block* sensor = state_.sensor ? state_.find(*state_.sensor) : nullptr;
  if (sensor)
    for (int i = 0; i < sensor->size(); ++i) own.push_back(sensor->offset + i);
  const Eigen::MatrixXd P_own = state_.P(own, own);
  const auto mayBe = [&](const Block& block, const Measurement& m) {
    const RestingMap::Marginal marginal = resting_.marginal(block, state_, own);
    auto predicted = predictMeasurement(pose(), block.block_kind, marginal.y, m);
    Eigen::MatrixXd H_own = Eigen::MatrixXd::Zero(predicted.z.size(), P_own.cols());
    if (sensor) H_own.rightCols(sensor->size()) = readWith(errorsOf(state_, sensor), m, predicted);
    H_own.leftCols<3>() = predicted.H_robot;
    const Eigen::MatrixXd cross = H_own * marginal.P_state * predicted.H_block.transpose();
    const Eigen::MatrixXd S = H_own * P_own * H_own.transpose() + cross + cross.transpose() +
                              predicted.H_block * marginal.P * predicted.H_block.transpose() + m.R;
    const Eigen::VectorXd nu = innovationOf(m, predicted.z);
    const Eigen::LLT<Eigen::MatrixXd> llt(S);
    return llt.info() != Eigen::Success || nu.dot(llt.solve(nu)) <= bound;
  };
  for (const Block& block : resting_.blocks()) {
    if (block.block_kind != BlockKind::kPoint) continue;
    const Eigen::Vector2d p = resting_.valueThen(block);
    const double spread2 = resting_.spread2(block);
    const double moved_m = move * std::sqrt(spread2);
    if (std::any_of(seen.begin(), seen.end(), [&](const Sighting& sighting) {
          return sighting.measurement->kind == block.landmark_kind &&
                 !sighting.look.rulesOut(p, moved_m, spread2, bound) &&
                 mayBe(block, *sighting.measurement);
        }))
      near.push_back(block.id);
  }
  return near;
}

namespace {

std::vector<LandmarkId> allOf(const State& state, const RestingMap& resting) {
  std::vector<LandmarkId> all;
  for (const Block& block : state.blocks) all.push_back(block.id);
  for (const Block& block : resting.blocks()) all.push_back(block.id);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

void EkfSlam::wakeAll() {
  if (!resting_.empty())
    resting_.exchange(state_, allOf(state_, resting_), options_.invariant, 0.0);
}

State EkfSlam::fullState() const {
  if (resting_.empty()) return state_;
  RestingMap resting = resting_;
  State state = state_;
  resting.exchange(state, allOf(state_, resting_), options_.invariant, 0.0);
  return state;
}

}  // namespace colonnade
