// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// Chi squared with 3 degrees of freedom: two measurements of a motion in the plane that differ by
/// more are unusual (5 %), or contradict each other (0.1 %).
inline constexpr double kUsual = 7.815;
inline constexpr double kConflict = 16.27;

/// One increment of two independent measurements of it, weighted by their information
/// (Gauss-Markov). Where they differ by more than their covariances allow, the covariance is wider
/// (Birge 1932); beyond the 0.1 % point of chi-squared the wheels are kept with twice their
/// standard deviations, because wheels slip more rarely than an alignment goes wrong.
MotionIncrement fuse(const MotionIncrement& wheels, const MotionIncrement& camera);

/// Twice the standard deviations, for wheels that something contradicts.
void doubt(MotionIncrement& wheels);

}  // namespace colonnade
