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
/// Several times the widest that gate can be in any direction, for a first look by distance.
constexpr double kFirstLook2 = 4.0 * 18.4;
constexpr double kFarthestInverseDepth = 1e-3;

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
  std::vector<std::pair<double, LandmarkId>> by_distance;
  const Eigen::Vector2d p_robot = pose().translation();
  for (const Block& block : state_.blocks) {
    if (isChoosable(block))
      by_distance.emplace_back(distanceTo(block, state_.values(block), p_robot), block.id);
    else
      active.push_back(block.id);
  }
  if (!resting_.empty()) {
    const Eigen::VectorXd x = resting_.values(state_);
    for (const Block& block : resting_.blocks())
      by_distance.emplace_back(distanceTo(block, x.segment(block.offset, block.size()), p_robot),
                               block.id);
  }
  const auto nearest = std::min<std::size_t>(by_distance.size(), options_.active_landmarks);
  std::nth_element(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(nearest),
                   by_distance.end());
  for (std::size_t i = 0; i < nearest; ++i) active.push_back(by_distance[i].second);
  for (const LandmarkId id : needed)
    if (state_.find(id) || isResting(id)) active.push_back(id);
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  resting_.exchange(state_, active, options_.invariant);
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
  const Eigen::VectorXd x = resting_.values(state_);
  const auto mayBe = [&](const Block& block, const Sighting& sighting) {
    const Measurement& m = *sighting.measurement;
    const Eigen::Vector2d y = x.segment<2>(block.offset);
    const double apart2 = (y - sighting.p_world).squaredNorm();
    const Eigen::MatrixXd P_block = resting_.covariance(block);
    if (apart2 > kFirstLook2 * (sighting.spread2 + P_block.trace())) return false;
    const auto predicted = predictMeasurement(pose(), block.block_kind, y, m);
    const Eigen::MatrixXd cross = predicted.H_robot * resting_.covarianceWithRobot(block, state_) *
                                  predicted.H_block.transpose();
    const Eigen::MatrixXd S = predicted.H_robot * P_robot * predicted.H_robot.transpose() + cross +
                              cross.transpose() +
                              predicted.H_block * P_block * predicted.H_block.transpose() + m.R;
    const Eigen::VectorXd nu = innovationOf(m, predicted.z);
    const Eigen::LLT<Eigen::MatrixXd> llt(S);
    return llt.info() != Eigen::Success || nu.dot(llt.solve(nu)) <= bound;
  };
  for (const Block& block : resting_.blocks()) {
    if (block.block_kind != BlockKind::kPoint) continue;
    if (std::any_of(seen.begin(), seen.end(), [&](const Sighting& sighting) {
          return sighting.measurement->kind == block.landmark_kind && mayBe(block, sighting);
        }))
      near.push_back(block.id);
  }
  return near;
}

State EkfSlam::fullState() const {
  if (resting_.empty()) return state_;
  RestingMap resting = resting_;
  State state = state_;
  std::vector<LandmarkId> all;
  for (const Block& block : state_.blocks) all.push_back(block.id);
  for (const Block& block : resting_.blocks()) all.push_back(block.id);
  std::sort(all.begin(), all.end());
  resting.exchange(state, all, options_.invariant);
  return state;
}

}  // namespace colonnade
