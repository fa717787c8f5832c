// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// The motion between two readings of wheel odometry, with the log's covariance where it states a
/// usable one, otherwise the random walk of the options.
MotionIncrement odometryIncrement(const OdometryReading& previous, const OdometryReading& now,
                                  const MotionOptions& options);

}  // namespace colonnade
