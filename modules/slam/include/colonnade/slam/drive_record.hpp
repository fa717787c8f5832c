// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/filter/smoother.hpp"
#include "colonnade/slam/range_bearing_estimator.hpp"

namespace colonnade {

/// Everything a range-bearing session was told and estimated, frame by frame, so that the drive can
/// be smoothed while it goes on and once it is over.
class DriveRecord {
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

  /// One frame, after the estimator's step: the robot moved on as the estimator has it.
  void add(double stamp_s, const RangeBearingScan& scan, const RangeBearingReport& report,
           const RangeBearingEstimator& estimator);
  /// Smooths what there is so far where it is time to (RangeBearing.smooth_every). Nobody knows
  /// where in the world a new map lies: with RangeBearing.world_with_map that is where the poses
  /// said at their moment suit best what is known of them now; without, where the log starts. Not
  /// for a loaded map, which holds the world and of which the filter knows how sure it is.
  void catchUp(const RangeBearingEstimator& estimator, const RangeBearingOptions& options);
  const Now& now() const { return now_; }
  /// Moves the robot on as the estimator has it; part of add(), alone where nothing is recorded.
  void follow(const RangeBearingEstimator& estimator);

  struct Smoothed {
    Trajectory trajectory;
    LandmarkMap map;
    /// Of the map's places together, two rows for each; empty for more than 500 landmarks.
    Eigen::MatrixXd covariance;
    /// Landmarks founded twice that are no more in the map, and those of the map they are.
    std::map<LandmarkId, LandmarkId> merged;
    Pose2 T_world_filter;                  ///< from the estimator's world
    std::optional<SensorEstimate> sensor;  ///< where its errors are estimated
    /// Where they are not: what would make the readings fit far better, to first order.
    std::optional<SensorEstimate> suspected;
    Smoothing how;
    /// Where identities are hidden but told: how.cost had every reading that was decided been taken
    /// for the landmark its identity is (bearersOf), where it is one. Larger: what is wrong fits
    /// better than what is right, unless landmarks were merged wrongly or a loaded map holds some
    /// twice.
    std::optional<double> cost_of_identities;
  };
  /// At the end: the drive past the landmarks the estimator knows, with its last word on which
  /// reading is of which; readings whose identity is believed are of its bearer. The map is the
  /// estimator's with places, extents and, up to 500 landmarks, covariances as smoothed; a landmark
  /// none of whose readings was used stays. The world lies as for Now. Landmarks without identity
  /// that were founded twice become one. Nothing when there is no reading of a landmark, or when
  /// smoothing failed: not finite, or half of the readings left out. from: the map the estimator
  /// went on from. Start and map then count as far as they are known, and a map that is left as it
  /// is stays; nothing where the drive saw more than 500 of its landmarks.
  std::optional<Smoothed> smoothed(const RangeBearingEstimator& estimator,
                                   const RangeBearingOptions& options,
                                   const std::optional<Resumption>& from = std::nullopt);

 private:
  struct Reading {
    std::size_t frame = 0;
    int identity = -1;
    std::optional<Measurement> measurement;
    std::optional<bool> used;  ///< when the drive was smoothed last
  };
  struct Prepared;
  /// What is known by now, to be smoothed; nothing where the loaded map is of no use.
  std::optional<Prepared> prepared(const RangeBearingEstimator& estimator, const LandmarkMap& map,
                                   const RangeBearingOptions& options,
                                   const std::optional<Resumption>& from) const;
  void followFilter(const RangeBearingEstimator& estimator);
  bool isDue(const RangeBearingOptions& options) const;
  /// Numbers of landmarks mean others in another history.
  void followHistory(const RangeBearingEstimator& estimator);
  /// With places as smoothed last.
  LandmarkMap mapSoFar(const RangeBearingEstimator& estimator) const;
  /// Where the world of such poses lies in that of the poses that were said.
  Pose2 asSaid(const std::vector<Pose2>& T_drive_robot) const;

  std::vector<double> stamps_s_;
  std::vector<Drive::Motion> motions_;
  std::vector<Reading> readings_;
  std::vector<Pose2> said_;                       ///< at their moment, but the last one
  std::vector<Pose2> T_world_robot_;              ///< as known by now
  Pose2 T_origin_first_;                          ///< the first of them in the world as it was then
  Pose2 T_filter_robot_;                          ///< the last one, as the estimator has it
  std::map<LandmarkId, Eigen::Vector2d> places_;  ///< as smoothed last
  std::vector<std::optional<LandmarkId>> decided_;  ///< when the drive was smoothed last
  std::optional<SensorErrors> sensor_;              ///< as smoothed last
  std::size_t tried_frames_ = 0;
  bool is_smoothed_ = false;  ///< the pose is that of the drive as smoothed last, moved on
  double share_ = 1.0;  ///< of the filter's covariance the smoothed pose had then, if it counts
  Now now_;
};

}  // namespace colonnade
