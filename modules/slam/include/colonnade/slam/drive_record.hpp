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

/// Everything a range-bearing session was told and estimated, frame by frame, so that the whole
/// drive can be smoothed once it is over.
class DriveRecord {
 public:
  /// One frame, after the estimator's step.
  void add(double stamp_s, const RangeBearingScan& scan, const RangeBearingReport& report,
           const Pose2& T_world_robot);

  struct Smoothed {
    Trajectory trajectory;
    LandmarkMap map;
    /// Of the map's places together, two rows for each; empty for more than 500 landmarks.
    Eigen::MatrixXd covariance;
    /// Landmarks founded twice that are no more in the map, and those of the map they are.
    std::map<LandmarkId, LandmarkId> merged;
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
  /// The drive past the landmarks the estimator knows at the end, with its last word on which
  /// reading is of which; readings whose identity is believed are of its bearer. The map is the
  /// estimator's with places, extents and, up to 500 landmarks, covariances as smoothed; a landmark
  /// none of whose readings was used stays. With RangeBearing.world_with_map it is put back where
  /// the estimator has it if it moved as a whole. Landmarks without identity that were founded
  /// twice become one. Nothing when there is no reading of a landmark,
  /// or when smoothing failed: not finite, or half of the readings left out.
  /// from: the map the estimator went on from. Start and map then count as far as they are known,
  /// and a map that is left as it is stays; nothing where the drive saw more than 500 of its
  /// landmarks.
  std::optional<Smoothed> smoothed(const RangeBearingEstimator& estimator,
                                   const RangeBearingOptions& options,
                                   const std::optional<Resumption>& from = std::nullopt) const;

 private:
  struct Reading {
    std::size_t frame = 0;
    int identity = -1;
    std::optional<Measurement> measurement;
  };
  struct NamedDrive {
    Drive drive;
    std::vector<int> identities;  ///< of the sightings, as the log tells them
  };
  NamedDrive driveOf(const RangeBearingEstimator& estimator, const LandmarkMap& map,
                     bool use_ids) const;

  std::vector<double> stamps_s_;
  std::vector<Pose2> T_world_robot_;
  std::vector<Drive::Motion> motions_;
  std::vector<Reading> readings_;
};

}  // namespace colonnade
