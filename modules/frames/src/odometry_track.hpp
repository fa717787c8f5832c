// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Motion increments (CActionRobotMovement2D) added up.
class MotionSum {
 public:
  /// `covariance` is in the axes of the robot before the increment; nothing: the log states none.
  void add(const Pose2& T_before_after, const std::optional<Eigen::Matrix3d>& covariance);
  void add(const MotionSum& later) { add(later.T_start_end_, later.covariance()); }

  const Pose2& T_start_end() const { return T_start_end_; }
  /// Of the whole motion, in the axes of its start; nothing when one increment stated none.
  std::optional<Eigen::Matrix3d> covariance() const;

 private:
  Pose2 T_start_end_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  bool covariance_known_ = true;
};

/// Absolute odometry readings (CObservationOdometry), interpolated at the time of a frame.
class OdometryTrack {
 public:
  static constexpr double kLongestGap_s = 1.0;    ///< between two readings that are bridged
  static constexpr double kLongestReach_s = 0.5;  ///< beyond the first or last reading

  /// Readings that repeat a stamp or go back in time are refused (false).
  bool add(double stamp_s, const Pose2& T_odom_robot);
  bool empty() const { return readings_.empty(); }
  double lastStamp() const { return readings_.back().stamp_s; }
  /// Linear in x, y and heading between two readings; the same motion goes on for a short time
  /// beyond the first and the last one.
  std::optional<Pose2> at(double stamp_s) const;
  /// Forgets what lies before `stamp_s`, save the two readings that at() may need.
  void forgetBefore(double stamp_s);

 private:
  struct Reading {
    double stamp_s;
    Pose2 T_odom_robot;
  };
  static Pose2 between(const Reading& a, const Reading& b, double stamp_s);
  std::deque<Reading> readings_;
};

}  // namespace colonnade
