// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dead_reckoning.hpp"

#include "colonnade/base/error.hpp"

namespace colonnade {

BaselineStep DeadReckoning::step(const Frame& frame) {
  if (!frame.odometry) {
    if (!started_)
      throw Error("dead-reckoning: the log holds no wheel odometry at its first frame");
    return {T_world_robot_, "no odometry", 0.0};
  }
  if (!started_) T_world_odom_ = frame.odometry->T_odom_robot.inverse();
  started_ = true;
  T_world_robot_ = T_world_odom_ * frame.odometry->T_odom_robot;
  return {T_world_robot_, "", 0.0};
}

}  // namespace colonnade
