// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/drive_record.hpp"

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
    const RangeBearingEstimator& estimator, const RangeBearingOptions& options) const {
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

  const auto before = drive.points_world;
  result.how = smooth(drive, options.known_gate_probability);
  if (!std::isfinite(result.how.cost) || 2 * result.how.unused >= drive.sightings.size())
    return std::nullopt;

  std::vector<double> used(drive.points_world.size(), 0.0);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) used[sighting.point] += 1.0;
  Pose2 T_map_start;
  if (options.world_with_map)
    T_map_start =
        motionOfMap(anchorsOf(before, used), anchorsOf(drive.points_world, used)).value_or(Pose2{});
  for (std::size_t k = 0; k < stamps_s_.size(); ++k)
    result.trajectory.push_back(
        {stamps_s_[k], (T_map_start * drive.T_world_robot[k]).toIsometry3()});
  const Eigen::Matrix2d R = T_map_start.rotation();
  for (std::size_t i = 0; i < result.map.size(); ++i) {
    if (used[i] == 0.0) continue;
    LandmarkRecord& landmark = result.map[i];
    landmark.p_world = transform(T_map_start, drive.points_world[i]);
    landmark.extent_a = landmark.extent_b = landmark.p_world;
    if (!result.how.point_covariances.empty())
      landmark.covariance = R * result.how.point_covariances[i] * R.transpose();
  }
  return result;
}

}  // namespace colonnade
