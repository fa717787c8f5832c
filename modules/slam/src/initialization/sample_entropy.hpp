// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/measurement.hpp"
#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// The sample relative entropy, nats, of way and place from their linearised Gaussian (thesis 2015,
/// eq. 6b; Bailey 2003): 1/n sum ln f(x_k) - ln g(x_k) over draws x_k of f, where f is the true
/// density of the place two bearings meet in and g the Gaussian of the Jacobians. Near 0 where a
/// Gaussian tells the truth; infinite where some rays do not meet in front of both cameras.
/// T_a_b: from the pose of the first bearing to that of the second, with its covariance (x, y,
/// phi).
double sampleRelativeEntropy(const Pose2& T_a_b, const Eigen::Matrix3d& covariance,
                             const Measurement& bearing_a, const Measurement& bearing_b,
                             int samples);

}  // namespace colonnade
