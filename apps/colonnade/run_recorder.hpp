// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/covariance_csv.hpp"
#include "colonnade/slam/session.hpp"

namespace colonnade {

/// What a run leaves beside its maps: trajectory, covariances, events and timings. Grows by a
/// few kilobytes a frame at most.
class RunRecorder {
 public:
  /// Without a pose, as long as nobody knows where in a map the robot is, it has no place in the
  /// trajectory.
  void add(const Frame& frame, const StepReport& report, const std::optional<Pose2>& T_world_robot,
           const Eigen::Matrix3d& covariance, const Pose2& T_world_origin);
  /// trajectory.tum, trajectory_covariance.csv, trajectory_final.tum (`final`), events.csv.
  void write(const std::filesystem::path& folder, const Trajectory& final) const;

  std::size_t frames() const { return times_.size(); }
  double duration() const;
  double pathLength() const { return path_length_m_; }
  const Trajectory& trajectory() const { return trajectory_; }
  const std::vector<StampedCovariance>& covariances() const { return covariances_; }
  /// Frames by what told their motion.
  const std::map<std::string, std::size_t>& motionSources() const { return motion_sources_; }
  const std::vector<StageTimes>& times() const { return times_; }

 private:
  Trajectory trajectory_;
  std::vector<StampedCovariance> covariances_;
  std::vector<Event> events_;
  std::vector<StageTimes> times_;
  std::map<std::string, std::size_t> motion_sources_;
  double path_length_m_ = 0.0;
  double first_stamp_s_ = 0.0, last_stamp_s_ = 0.0;
};

}  // namespace colonnade
