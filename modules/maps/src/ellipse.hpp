// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace colonnade {

/// The closed outline of the region that holds 95 % of a Gaussian in the plane; empty for what is
/// no covariance (not finite, or negative in some direction).
std::vector<Eigen::Vector2d> ellipse95(const Eigen::Vector2d& mean,
                                       const Eigen::Matrix2d& covariance);

}  // namespace colonnade
