// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "colonnade/base/rigid_fit.hpp"
#include "prepared_drive.hpp"

namespace colonnade {
namespace {

/// Drives that are long are smoothed when they have grown by this share, so that the time for each
/// frame does not grow with them.
constexpr double kGrowth = 0.01;
/// Poses agree where the robot and a point so far ahead of it do.
constexpr double kAhead_m = 1.0;

}  // namespace

/// As the estimator has it, from where the robot was known to be before.
void DriveRecord::moveOn(const RangeBearingEstimator& estimator) {
  const Pose2 T_filter_robot = estimator.pose();
  if (!T_world_robot_.empty()) said_.push_back(now_.T_world_robot);
  if (smoothed_frames_ == 0) {
    now_ = {T_filter_robot, estimator.poseCovariance(), estimator.worldOrigin(), {}};
  } else {
    Eigen::Matrix3d J_before, J_motion;
    now_.T_world_robot = compose(now_.T_world_robot, T_filter_robot_.inverse() * T_filter_robot,
                                 &J_before, &J_motion);
    now_.covariance = (J_before * now_.covariance * J_before.transpose() +
                       J_motion * motions_.back().covariance * J_motion.transpose())
                          .eval();
    now_.T_world_filter = now_.T_world_robot * T_filter_robot.inverse();
  }
  T_filter_robot_ = T_filter_robot;
  if (T_world_robot_.empty()) T_origin_first_ = now_.T_world_origin.inverse() * T_filter_robot;
  T_world_robot_.push_back(now_.T_world_robot);
}

bool DriveRecord::isDue(const RangeBearingOptions& options) const {
  const std::size_t frames = stamps_s_.size();
  const double wait = std::max<double>(options.smooth_every, kGrowth * static_cast<double>(frames));
  return options.smooth && options.smooth_every > 0 &&
         static_cast<double>(frames - tried_frames_) >= wait;
}

void DriveRecord::followHistory(const RangeBearingEstimator& estimator) {
  const auto decisions = estimator.decisions();
  if (!std::equal(decided_.begin(), decided_.end(), decisions.begin())) {
    places_.clear();
    for (Reading& reading : readings_) reading.used.reset();
  }
  decided_ = decisions;
}

LandmarkMap DriveRecord::mapSoFar(const RangeBearingEstimator& estimator) const {
  LandmarkMap map = moved(estimator.map(), now_.T_world_filter);
  for (LandmarkRecord& landmark : map)
    if (const auto known = places_.find(landmark.id); known != places_.end())
      landmark.p_world = landmark.extent_a = landmark.extent_b = known->second;
  return map;
}

void DriveRecord::catchUp(const RangeBearingEstimator& estimator,
                          const RangeBearingOptions& options) {
  if (!isDue(options)) return;
  tried_frames_ = stamps_s_.size();
  followHistory(estimator);
  const LandmarkMap map = mapSoFar(estimator);
  auto prepared = this->prepared(estimator, map, options, std::nullopt);
  auto& [drive, identities, readings, places, known] = *prepared;
  const Smoothing how = smoothOn(drive, options.known_gate_probability);
  if (how.steps == 0 || !isGood(drive, how)) return;
  const auto covariance = lastPoseCovariance(drive);
  if (!covariance) return;

  const Pose2 T_world_drive = options.world_with_map ? asSaid(drive.T_world_robot) : Pose2{};
  for (std::size_t k = 0; k < T_world_robot_.size(); ++k)
    T_world_robot_[k] = T_world_drive * drive.T_world_robot[k];
  places_.clear();
  for (std::size_t i = 0; i < places.size(); ++i)
    places_[map[places[i]].id] = transform(T_world_drive, drive.points_world[i]);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings_[readings[i]].used = drive.sightings[i].used;
  smoothed_frames_ = tried_frames_;

  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T_world_drive.rotation();
  now_.T_world_robot = T_world_robot_.back();
  now_.covariance = R * *covariance * R.transpose();
  now_.T_world_filter = now_.T_world_robot * T_filter_robot_.inverse();
  now_.T_world_origin = T_world_robot_.front() * T_origin_first_.inverse();
}

Pose2 DriveRecord::asSaid(const std::vector<Pose2>& T_drive_robot) const {
  if (said_.empty()) return {};
  std::vector<PointPair> pairs;
  for (std::size_t k = 0; k < said_.size(); ++k) {
    pairs.push_back({said_[k].translation(), T_drive_robot[k].translation()});
    const Eigen::Vector2d ahead(kAhead_m, 0.0);
    pairs.push_back({transform(said_[k], ahead), transform(T_drive_robot[k], ahead)});
  }
  return rigidFit(pairs);
}

}  // namespace colonnade
