// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/slam/explanation.hpp"

namespace colonnade {

/// What a whole drive says.
struct SmoothedDrive {
  Trajectory trajectory;
  LandmarkMap map;
  /// Of the map's places together, two rows for each; empty for more than 500 landmarks.
  Eigen::MatrixXd covariance;
  /// Landmarks founded twice that are no more in the map, and those of the map they are.
  std::map<LandmarkId, LandmarkId> merged;
  std::map<LandmarkId, int> identities;              ///< of landmarks, where believed and known
  std::vector<std::optional<LandmarkId>> decisions;  ///< for each reading, of map
  /// Minus twice the logarithm of the probability of all readings, but for what is the same for
  /// every explanation: what the drive costs and what landmarks and readings of none cost by
  /// RangeBearing.birth_share and outlier_share. Smaller: explained better.
  double surprise = 0.0;
  bool explained_backwards = false;      ///< by decisions taken from the end of the log
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

/// The drive past the landmarks that explain it; readings whose identity is believed are of its
/// bearer. The map is the explanation's with places, extents and, up to 500 landmarks, covariances
/// as smoothed; a landmark none of whose readings was used stays. The world lies as for DriveSoFar.
/// Landmarks without identity that were founded twice become one. Nothing when there is no reading
/// of a landmark, or when smoothing failed: not finite, or half of the readings left out. from: the
/// map the estimator went on from. Start and map then count as far as they are known, and a map
/// that is left as it is stays; nothing where the drive saw more than 500 of its landmarks.
std::optional<SmoothedDrive> smoothedDrive(const DriveRecord& record,
                                           const Explanation& explanation, const DriveSoFar& so_far,
                                           const RangeBearingOptions& options,
                                           const std::optional<Resumption>& from = std::nullopt);

/// The same as the estimator explains it. With RangeBearing.look_back, identities hidden and no map
/// loaded, an estimator of its own explains it once more from its end, and the explanation that is
/// less of a surprise counts. That takes as long as the estimator took, and is left where it would
/// take longer than a minute.
std::optional<SmoothedDrive> smoothedDrive(const DriveRecord& record, DriveSoFar& so_far,
                                           const RangeBearingEstimator& estimator,
                                           const RangeBearingOptions& options,
                                           const FilterOptions& filter_options,
                                           const std::optional<Resumption>& from = std::nullopt);

}  // namespace colonnade
