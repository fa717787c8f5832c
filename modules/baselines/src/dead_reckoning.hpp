// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/baselines/baseline.hpp"

namespace colonnade {

/// Wheel odometry as the log has it, from the first frame on. A frame without it is lost.
class DeadReckoning : public Baseline {
 public:
  BaselineStep step(const Frame& frame) override;

 private:
  bool started_ = false;
  Pose2 T_world_odom_;
  Pose2 T_world_robot_;
};

}  // namespace colonnade
