// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"

namespace colonnade {

/// One increment of two independent measurements of it, weighted by their information
/// (Gauss-Markov). Where they differ by more than their covariances allow, the result says so:
/// first by a wider covariance (Birge 1932), and beyond the 0.1 % point of chi-squared by keeping
/// the wheels' motion with a covariance that reaches the camera's as well, because wheels slip more
/// rarely than something large moves before a camera.
MotionIncrement fuse(const MotionIncrement& wheels, const MotionIncrement& camera);

}  // namespace colonnade
