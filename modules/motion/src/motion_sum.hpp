// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// Independent motions one after another: where they lead, and how sure that is.
class MotionSum {
 public:
  void add(const MotionIncrement& increment);
  const Pose2& T_start_now() const { return T_start_now_; }
  /// Of (x, y, phi) of T_start_now, in the axes of the start.
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  Pose2 T_start_now_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace colonnade
