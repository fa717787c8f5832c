// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

/// Share of right measurements whose landmark is found among the resting ones.
constexpr double kNearProbability = 0.9999;
/// Four times that gate, for a first look by distance: Var(a - b) is at most 2 (Var a + Var b).
constexpr double kFirstLook2 = 4.0 * 18.4;
constexpr double kFarthestInverseDepth = 1e-3;
/// What is active lies around a point ahead of the robot, by this share of its radius: the way it
/// goes is the way it looks, and landmarks are exchanged half as often. Farther ahead, what is seen
/// behind it would rest.
constexpr double kAhead = 0.5;

/// How far the robot is from a landmark; from the nearest seen point of a floor edge.
double distanceTo(const Block& block, const BlockVector& y, const Eigen::Vector2d& p_robot) {
  switch (block.block_kind) {
    case BlockKind::kFloorLine: {
      const Eigen::Vector2d m(std::cos(y(2)), std::sin(y(2)));
      const Eigen::Vector2d from_foot = p_robot - y.head<2>() - y(3) * m;
      const double along = -from_foot.x() * m.y() + from_foot.y() * m.x();
      const double beside =
          along - std::clamp(along, block.evidence.along_min_m,
                             std::max(block.evidence.along_min_m, block.evidence.along_max_m));
      return std::hypot(m.dot(from_foot), beside);
    }
    case BlockKind::kInverseDepth:
      return ((y(3) > kFarthestInverseDepth ? pointOf(y) : Eigen::Vector2d(y.head<2>())) - p_robot)
          .norm();
    default:
      return (y.head<2>() - p_robot).norm();
  }
}

struct Place {
  const Block* block;
  BlockVector y;
  double distance = 0.0;
};

/// The `count` nearest come first; returns the distance of the farthest of them.
double nearest(std::vector<Place>& places, std::size_t count, const Eigen::Vector2d& p_world) {
  for (Place& place : places) place.distance = distanceTo(*place.block, place.y, p_world);
  if (count == 0) return 0.0;
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count - 1),
                   places.end(), [](const Place& a, const Place& b) {
                     return std::pair(a.distance, a.block->id) < std::pair(b.distance, b.block->id);
                   });
  return places[count - 1].distance;
}

}  // namespace

void EkfSlam::focus(std::span<const LandmarkId> needed) {
  if (options_.active_landmarks <= 0 || fixed_ > 0) return;
  const auto isChoosable = [](const Block& b) { return b.isLandmark() && !b.evidence.hypothesis; };
  const auto most = static_cast<std::ptrdiff_t>(options_.active_landmarks);
  const bool wakes =
      std::any_of(needed.begin(), needed.end(), [&](LandmarkId id) { return isResting(id); });
  if (!wakes && std::count_if(state_.blocks.begin(), state_.blocks.end(), isChoosable) <= 2 * most)
    return;

  std::vector<LandmarkId> active;
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
  const double radius = nearest(places, count, pose().translation());
  nearest(places, count, transform(pose(), Eigen::Vector2d(kAhead * radius, 0.0)));
  for (std::size_t i = 0; i < count; ++i) active.push_back(places[i].block->id);
  for (const LandmarkId id : needed)
    if (state_.find(id) || isResting(id)) active.push_back(id);
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  resting_.exchange(state_, active, options_.invariant, options_.negligible_gain);
}

namespace {

/// A measurement with range, and where and how widely around it its landmark may be.
struct Sighting {
  const Measurement* measurement;
  Eigen::Vector2d p_world;
  double spread2;  ///< m^2, but for the landmark's own
};

std::vector<Sighting> sightings(std::span<const Measurement> measurements, const Pose2& pose,
                                const Eigen::Matrix3d& P_robot) {
  std::vector<Sighting> sightings;
  for (const Measurement& m : measurements) {
    if (!m.hasRange() || m.kind == LandmarkKind::kFloorEdge) continue;
    if (!m.z.allFinite() || !m.R.allFinite()) continue;
    const Eigen::Vector2d p_world = pointFromRange(pose, m).block;
    const double range2 = (p_world - pose.translation()).squaredNorm();
    sightings.push_back(
        {&m, p_world,
         P_robot.topLeftCorner<2, 2>().trace() + range2 * (P_robot(2, 2) + m.R(0, 0)) + m.R(1, 1)});
  }
  return sightings;
}

}  // namespace

std::vector<LandmarkId> EkfSlam::restingNear(std::span<const Measurement> measurements) const {
  std::vector<LandmarkId> near;
  const Eigen::Matrix3d P_robot = poseCovariance();
  const auto seen = sightings(measurements, pose(), P_robot);
  if (resting_.empty() || seen.empty()) return near;
  const double bound = chiSquareQuantile(kNearProbability, 2);
  const double move = resting_.largestMove(state_);
  const auto mayBe = [&](const Block& block, const Sighting& sighting) {
    const Measurement& m = *sighting.measurement;
    const double spread2 = resting_.spread2(block);
    const double apart =
        (resting_.valueThen(block) - sighting.p_world).norm() - move * std::sqrt(spread2);
    if (apart > 0.0 && apart * apart > kFirstLook2 * (sighting.spread2 + spread2)) return false;
    const RestingMap::Marginal marginal = resting_.marginal(block, state_);
    const auto predicted = predictMeasurement(pose(), block.block_kind, marginal.y, m);
    const Eigen::MatrixXd cross =
        predicted.H_robot * marginal.P_robot * predicted.H_block.transpose();
    const Eigen::MatrixXd S = predicted.H_robot * P_robot * predicted.H_robot.transpose() + cross +
                              cross.transpose() +
                              predicted.H_block * marginal.P * predicted.H_block.transpose() + m.R;
    const Eigen::VectorXd nu = innovationOf(m, predicted.z);
    const Eigen::LLT<Eigen::MatrixXd> llt(S);
    return llt.info() != Eigen::Success || nu.dot(llt.solve(nu)) <= bound;
  };
  // sqrt(a + b) <= sqrt(a) + sqrt(b): what is farther than this fails the first look as well.
  const double first_look = std::sqrt(kFirstLook2);
  std::vector<double> reaches;
  for (const Sighting& sighting : seen) reaches.push_back(first_look * std::sqrt(sighting.spread2));
  const auto isFar = [&](const Eigen::Vector2d& p, double own_reach, std::size_t i) {
    const double reach = own_reach + reaches[i];
    return (p - seen[i].p_world).squaredNorm() > reach * reach;
  };
  for (const Block& block : resting_.blocks()) {
    if (block.block_kind != BlockKind::kPoint) continue;
    const Eigen::Vector2d p = resting_.valueThen(block);
    const double own_reach = (move + first_look) * std::sqrt(resting_.spread2(block));
    bool near_one = false;
    for (std::size_t i = 0; i < seen.size() && !near_one; ++i)
      near_one = !isFar(p, own_reach, i) && seen[i].measurement->kind == block.landmark_kind &&
                 mayBe(block, seen[i]);
    if (near_one) near.push_back(block.id);
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
