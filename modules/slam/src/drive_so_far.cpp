// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "colonnade/base/rigid_fit.hpp"
#include "prepared_drive.hpp"

namespace colonnade {
namespace {

/// One frame pays for so many poses and readings: long drives are smoothed less often, so that the
/// time for a frame does not grow with them in the mean.
constexpr double kPaidByFrame = 250.0;
/// How much larger variances are than the filter says between two times, at most.
constexpr double kDoubt = 4.0;
/// Poses agree where the robot and a point so far ahead of it do.
constexpr double kAhead_m = 1.0;

/// In axes turned by T.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, const Pose2& T) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T.rotation();
  return R * covariance * R.transpose();
}

}  // namespace

void DriveRecord::followFilter(const RangeBearingEstimator& estimator) {
  const Pose2 T = now_.T_world_filter;
  now_ = {T * estimator.pose(), turned(estimator.poseCovariance(), T), T * estimator.worldOrigin(),
          T};
}

void DriveRecord::follow(const RangeBearingEstimator& estimator) {
  const Pose2 T_filter_robot = estimator.pose();
  if (!T_world_robot_.empty()) said_.push_back(now_.T_world_robot);
  if (!is_smoothed_) {
    followFilter(estimator);
  } else {
    Eigen::Matrix3d J_before, J_motion;
    now_.T_world_robot = compose(now_.T_world_robot, T_filter_robot_.inverse() * T_filter_robot,
                                 &J_before, &J_motion);
    now_.T_world_filter = now_.T_world_robot * T_filter_robot.inverse();
    // By wheels alone less and less is known; what was read since says more, but errors that are
    // alike from frame to frame make the filter sure of it.
    const Eigen::Matrix3d by_wheels = J_before * now_.covariance * J_before.transpose() +
                                      J_motion * motions_.back().covariance * J_motion.transpose();
    const Eigen::Matrix3d by_filter =
        kDoubt * share_ * turned(estimator.poseCovariance(), now_.T_world_filter);
    now_.covariance = by_filter.determinant() < by_wheels.determinant() ? by_filter : by_wheels;
  }
  T_filter_robot_ = T_filter_robot;
  if (T_world_robot_.empty()) T_origin_first_ = now_.T_world_origin.inverse() * T_filter_robot;
  T_world_robot_.push_back(now_.T_world_robot);
}

bool DriveRecord::isDue(const RangeBearingOptions& options) const {
  if (!options.smooth || options.smooth_every == 0) return false;
  const std::size_t frames = stamps_s_.size();
  const double work = static_cast<double>(frames + readings_.size());
  return static_cast<double>(frames - tried_frames_) >=
         std::max<double>(options.smooth_every, work / kPaidByFrame);
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
  const auto covariance =
      how.steps > 0 && isGood(drive, how) ? lastPoseCovariance(drive) : std::nullopt;
  is_smoothed_ = covariance.has_value();
  if (!covariance) {
    followFilter(estimator);
    T_world_robot_.back() = now_.T_world_robot;
    return;
  }

  const Pose2 T_world_drive = options.world_with_map ? asSaid(drive.T_world_robot) : Pose2{};
  for (std::size_t k = 0; k < T_world_robot_.size(); ++k)
    T_world_robot_[k] = T_world_drive * drive.T_world_robot[k];
  places_.clear();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Drive::Sighting& sighting = drive.sightings[i];
    readings_[readings[i]].used = sighting.used;
    if (sighting.used)
      places_[map[places[sighting.point]].id] =
          transform(T_world_drive, drive.points_world[sighting.point]);
  }
  if (drive.sensor) sensor_ = drive.sensor->errors;
  now_.T_world_robot = T_world_robot_.back();
  now_.covariance = turned(*covariance, T_world_drive);
  now_.T_world_filter = now_.T_world_robot * T_filter_robot_.inverse();
  now_.T_world_origin = T_world_robot_.front() * T_origin_first_.inverse();
  // With bearings alone the filter does not know how sure it is.
  const double share =
      std::cbrt(covariance->determinant() / estimator.poseCovariance().determinant());
  share_ = options.bearing_only || !std::isfinite(share) ? HUGE_VAL : share;
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
