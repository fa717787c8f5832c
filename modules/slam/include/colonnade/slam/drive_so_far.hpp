// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "colonnade/filter/incremental_smoother.hpp"
#include "colonnade/slam/drive_record.hpp"

namespace colonnade {

/// Where the robot is and was as far as anyone knows by now: the drive so far is smoothed while it
/// goes on, and between two times the robot moves on as the filter has it.
class DriveSoFar {
 public:
  /// The robot at the last frame, as it is known by then.
  struct Now {
    Pose2 T_world_robot;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, phi)
    /// StampedCovariance::T_world_origin.
    Pose2 T_world_origin;
    /// From the estimator's world; the same one until something is smoothed.
    Pose2 T_world_filter;
  };

  /// One frame, after the estimator's step: the robot moved on as the estimator has it, with this
  /// covariance by its wheels.
  void follow(const RangeBearingEstimator& estimator, const Eigen::Matrix3d& motion_covariance);
  /// Smooths what there is so far where it is time to (RangeBearing.smooth_every). Nobody knows
  /// where in the world a new map lies: with RangeBearing.world_with_map that is where the poses
  /// said at their moment suit best what is known of them now; without, where the log starts. Not
  /// for a loaded map, which holds the world and of which the filter knows how sure it is.
  void catchUp(const DriveRecord& record, const RangeBearingEstimator& estimator,
               const RangeBearingOptions& options);
  /// What another history of decisions says otherwise is forgotten, as numbers of landmarks mean
  /// others in it.
  void followHistory(const std::vector<std::optional<LandmarkId>>& decisions);

  const Now& now() const { return now_; }
  /// Of all frames, as known by now.
  std::vector<Pose2> poses();
  /// As smoothed last, of landmarks that have readings.
  std::map<LandmarkId, Eigen::Vector2d> places();
  /// Whether a reading was within the gate when the drive was smoothed last, if it was in it.
  std::optional<bool> isUsed(std::size_t reading) const;
  /// As smoothed last; none: not estimated.
  std::optional<SensorErrors> sensorErrors();
  /// Where the world of such poses, by frames, lies in that of the poses that were said.
  Pose2 asSaid(const std::function<Pose2(std::size_t)>& T_drive_robot) const;

 private:
  struct Sighted {
    std::size_t sighting = 0, point = 0;
  };
  struct Founded {
    std::size_t point = 0, reading = 0;
  };
  void start(const RangeBearingOptions& options);
  void stop();
  /// Points and the readings of them.
  void forget(const std::function<bool(LandmarkId, const Founded&)>& which);
  void addFrames(const DriveRecord& record);
  void addReadings(const DriveRecord& record, const RangeBearingEstimator& estimator,
                   const RangeBearingOptions& options);
  bool foundPoint(LandmarkId landmark, std::size_t reading, const DriveRecord& record,
                  const RangeBearingEstimator& estimator, const RangeBearingOptions& options);
  void release(std::size_t reading);
  void followFilter(const RangeBearingEstimator& estimator);
  void takeResult(const RangeBearingEstimator& estimator, const RangeBearingOptions& options);

  bool begun_ = false;
  std::vector<Pose2> said_;  ///< at their moment, but the last one
  Now now_;
  Pose2 T_origin_first_;  ///< the first one in the world as it was then
  Pose2 T_filter_robot_;  ///< the last one, as the estimator has it

  std::optional<IncrementalSmoother> smoother_;
  Pose2 T_world_drive_;  ///< of the smoother's world
  std::vector<std::optional<LandmarkId>> decided_;
  std::vector<std::optional<Sighted>> sighted_;  ///< readings in the smoother
  std::vector<std::size_t> open_;                ///< readings of no landmark yet
  std::size_t released_ = 0;
  std::map<LandmarkId, Founded> points_;
  std::size_t next_frames_ = 0;  ///< when it is time again
  bool is_smoothed_ = false;     ///< the pose is that of the drive as smoothed last, moved on
  double share_ = 1.0;  ///< of the filter's covariance the smoothed pose had then, if it counts
};

}  // namespace colonnade
