// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion.hpp"
#include "colonnade/slam/event.hpp"
#include "colonnade/slam/identity_score.hpp"
#include "colonnade/slam/range_bearing_options.hpp"
#include "colonnade/slam/resumption.hpp"

namespace colonnade {

/// What became of one frame of readings, as the likeliest history has it.
struct RangeBearingReport {
  std::vector<std::optional<LandmarkId>> landmarks;  ///< one for each reading of the scan
  std::vector<bool> founded;                         ///< the reading founded its landmark
  /// The readings in the plane of the robot, R widened for errors that are alike; nothing for one
  /// that cannot be used.
  std::vector<std::optional<Measurement>> measurements;
  /// The motion before this frame as the filter took it: none while it waits for a landmark or when
  /// it refused it; when every landmark disagreed, with the doubt about the pose.
  Pose2 T_previous_robot;
  Eigen::Matrix3d motion_covariance = Eigen::Matrix3d::Zero();
  std::vector<Event> events;
};

/// EKF-SLAM on readings of point landmarks (range and bearing, or bearing alone): the same filter
/// as with cameras, with known, hidden or partly known identities.
///
/// Readings whose identity the landmark map knows correct the filter together, behind a gate; an
/// identity seen for the first time founds a landmark after the correction. Readings without
/// identity are associated frame by frame (nn, jcbb), or `hypotheses` histories of associations are
/// carried on side by side, each with its own filter, weighed by the likelihood of their readings
/// (Reid 1979; the number of histories is bounded, those that differ only in decisions long past
/// are one). What a history decided may change later: decisions() tells the likeliest one's.
///
/// Bearings alone: the first bearing to an identity founds a landmark on its ray, its inverse depth
/// in doubt (Montiel, Civera, Davison 2006); with wait_for_parallax it waits, with a clone of its
/// pose in the state, until another one gives enough parallax. They need identities.
class RangeBearingEstimator {
 public:
  /// Throws Error (kUsage) for options that contradict each other. Filter.gate_probability and
  /// Filter.error_correlation_s give way to those of RangeBearingOptions.
  RangeBearingEstimator(const RangeBearingOptions& options, const FilterOptions& filter_options);
  /// Goes on from a map, or finds its way in it and founds no landmark. Throws Error (kUsage)
  /// besides for a map made from cameras and for a start anywhere.
  RangeBearingEstimator(const RangeBearingOptions& options, const FilterOptions& filter_options,
                        const Resumption& from);
  ~RangeBearingEstimator();
  RangeBearingEstimator(RangeBearingEstimator&&) noexcept;
  RangeBearingEstimator& operator=(RangeBearingEstimator&&) noexcept;

  /// One frame: motion since the former one, then its readings. Throws Error (kUsage) for a bearing
  /// without identity in bearing_only.
  RangeBearingReport step(double stamp_s, const MotionIncrement& motion,
                          const RangeBearingScan& scan);

  /// Of the likeliest history. Its world starts where the log does; that of pose() and map() stays
  /// with the map (RangeBearing.world_with_map): between the two lies a known motion.
  const EkfSlam& filter() const;
  Pose2 pose() const;
  Eigen::Matrix3d poseCovariance() const;
  /// That motion: where the filter's world lies in that of pose(), whose covariance is about the
  /// filter's.
  Pose2 worldOrigin() const;
  LandmarkMap map() const;
  /// Of a landmark of map(), as the filter last worked with it; at no cost in large maps.
  std::optional<Eigen::Vector2d> placeOf(LandmarkId landmark) const;
  /// What a later run needs to go on; in the world of map().
  SavedMap savedMap() const;
  /// The identity in the log, where it is believed and known.
  std::optional<int> identityOf(LandmarkId landmark) const;
  /// The landmark of every reading so far, in the order of the log.
  std::vector<std::optional<LandmarkId>> decisions() const;
  std::size_t histories() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
