// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "colonnade/slam/drive_so_far.hpp"

namespace colonnade {

/// One way to explain a drive: which landmark each reading is of, and where robot and landmarks
/// then are, near enough to start smoothing from.
struct Explanation {
  std::vector<Pose2> T_world_robot;                  ///< one for each frame
  std::vector<std::optional<LandmarkId>> decisions;  ///< one for each reading
  std::vector<bool> used;                            ///< the same: its measurement suits
  LandmarkMap map;
  std::map<LandmarkId, int> identities;  ///< in the log, where believed and known
  std::optional<SensorErrors> sensor;    ///< where they are estimated
};

/// As the estimator's likeliest history has it by now, robot and new landmarks where the drive so
/// far places them. loaded: the map is the one the estimator went on from, and stays.
Explanation explanationOf(const DriveRecord& record, DriveSoFar& so_far,
                          const RangeBearingEstimator& estimator, bool loaded);

}  // namespace colonnade
