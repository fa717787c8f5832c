// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion_sum.hpp"

namespace colonnade {

void MotionSum::add(const MotionIncrement& increment) {
  Eigen::Matrix3d by_start, by_increment;
  T_start_now_ = compose(T_start_now_, increment.T_previous_robot, &by_start, &by_increment);
  covariance_ = (by_start * covariance_ * by_start.transpose() +
                 by_increment * increment.covariance * by_increment.transpose())
                    .eval();
}

}  // namespace colonnade
