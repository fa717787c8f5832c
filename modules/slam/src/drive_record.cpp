// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/drive_record.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "range_bearing_world.hpp"

namespace colonnade {
namespace {

std::vector<WorldAnchor> anchorsOf(const std::vector<Eigen::Vector2d>& points,
                                   const std::vector<double>& weights) {
  std::vector<WorldAnchor> anchors;
  for (std::size_t i = 0; i < points.size(); ++i) anchors.push_back({points[i], weights[i]});
  return anchors;
}

/// Of a map of more landmarks the information is too much to smooth with.
constexpr std::size_t kMostOfMap = 500;

/// What the map says of the first landmarks of `now`, those that are still left of it, and of the
/// pose after the first motion. Nothing for a map that is too large or says more than it can.
std::optional<Drive::Prior> priorOf(const Resumption& from, const LandmarkMap& now,
                                    const Drive::Motion& first) {
  const State& then = from.map.state;
  Drive::Prior prior;
  std::vector<Eigen::Index> rows;
  for (const LandmarkRecord& landmark : now) {
    const Block* block = then.find(landmark.id);
    if (!block) break;  // ids ascend: from here on they are new
    if (block->block_kind != BlockKind::kPoint) return std::nullopt;
    prior.points_world.emplace_back(then.values(*block));
    rows.insert(rows.end(), {block->offset, block->offset + 1});
  }
  if (prior.points_world.size() > kMostOfMap) return std::nullopt;
  Eigen::Matrix3d J_start, J_motion;
  prior.T_world_start = compose(from.T_world_robot, first.T_previous_robot, &J_start, &J_motion);
  const Eigen::Matrix3d P = J_start * from.covariance * J_start.transpose() +
                            J_motion * first.covariance * J_motion.transpose();
  prior.information_start = P.inverse();
  const Eigen::LLT<Eigen::MatrixXd> map(then.P(rows, rows));
  if (map.info() != Eigen::Success) return std::nullopt;
  const auto size = static_cast<Eigen::Index>(rows.size());
  prior.information_points = map.solve(Eigen::MatrixXd::Identity(size, size));
  return prior;
}

}  // namespace

void DriveRecord::add(double stamp_s, const RangeBearingScan& scan,
                      const RangeBearingReport& report, const Pose2& T_world_robot) {
  for (std::size_t i = 0; i < scan.readings.size(); ++i)
    readings_.push_back({stamps_s_.size(), scan.readings[i].id, report.measurements[i]});
  stamps_s_.push_back(stamp_s);
  T_world_robot_.push_back(T_world_robot);
  motions_.push_back({report.T_previous_robot, report.motion_covariance});
}

std::optional<DriveRecord::Smoothed> DriveRecord::smoothed(
    const RangeBearingEstimator& estimator, const RangeBearingOptions& options,
    const std::optional<Resumption>& from) const {
  if (T_world_robot_.empty()) return std::nullopt;
  Smoothed result;
  result.map = estimator.map();
  Drive drive{T_world_robot_, motions_, {}, {}};
  std::map<LandmarkId, std::size_t> point_of_landmark;
  std::map<int, std::size_t> point_of_identity;
  for (const LandmarkRecord& landmark : result.map) {
    const std::size_t point = drive.points_world.size();
    point_of_landmark[landmark.id] = point;
    if (const auto identity = estimator.identityOf(landmark.id))
      point_of_identity[*identity] = point;
    drive.points_world.push_back(landmark.p_world);
  }
  const auto decisions = estimator.decisions();
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const Reading& reading = readings_[i];
    if (!reading.measurement) continue;
    std::optional<std::size_t> point;
    const auto bearer = point_of_identity.find(reading.identity);
    if (options.use_ids && reading.identity >= 0 && bearer != point_of_identity.end()) {
      point = bearer->second;
    } else if (decisions[i]) {
      const auto landmark = point_of_landmark.find(*decisions[i]);
      if (landmark != point_of_landmark.end()) point = landmark->second;
    }
    if (!point) continue;
    drive.sightings.push_back({reading.frame, *point, *reading.measurement});
  }

  if (from && !(drive.prior = priorOf(*from, result.map, motions_.front()))) return std::nullopt;
  const auto before = drive.points_world;
  result.how = smooth(drive, options.known_gate_probability);
  if (!std::isfinite(result.how.cost) || 2 * result.how.unused >= drive.sightings.size())
    return std::nullopt;

  std::vector<double> used(drive.points_world.size(), 0.0);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) used[sighting.point] += 1.0;
  Pose2 T_map_start;
  if (options.world_with_map && !from)
    T_map_start =
        motionOfMap(anchorsOf(before, used), anchorsOf(drive.points_world, used)).value_or(Pose2{});
  for (std::size_t k = 0; k < stamps_s_.size(); ++k)
    result.trajectory.push_back(
        {stamps_s_[k], (T_map_start * drive.T_world_robot[k]).toIsometry3()});
  if (from && from->localize) return result;
  const Eigen::Matrix2d R = T_map_start.rotation();
  result.covariance = result.how.covariance;
  for (Eigen::Index i = 0; i < result.covariance.rows(); i += 2) {
    result.covariance.middleRows<2>(i) = (R * result.covariance.middleRows<2>(i)).eval();
    result.covariance.middleCols<2>(i) =
        (result.covariance.middleCols<2>(i) * R.transpose()).eval();
  }
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  for (std::size_t i = 0; i < result.map.size(); ++i) {
    LandmarkRecord& landmark = result.map[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    const bool moves = used[i] > 0.0 || (drive.prior && i < drive.prior->points_world.size());
    if (moves) {
      landmark.p_world = transform(T_map_start, drive.points_world[i]);
      landmark.extent_a = landmark.extent_b = landmark.p_world;
    }
    if (result.covariance.size() == 0) continue;
    if (moves) {
      landmark.covariance = result.covariance.block<2, 2>(row, row);
      continue;
    }
    result.covariance.middleRows<2>(row).setZero();
    result.covariance.middleCols<2>(row).setZero();
    result.covariance.block<2, 2>(row, row) = landmark.covariance;
  }
  return result;
}

}  // namespace colonnade
