// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace colonnade {

/// A with D D^T = C Psi C^T for D = C A, of as few columns as it takes for the rows of `C_judged`:
/// those of C, or a part of them in units of their deviations, of whose variances a share of
/// `negligible` may be left out.
Eigen::MatrixXd lowRankFactor(const Eigen::MatrixXd& C_judged, const Eigen::MatrixXd& Psi,
                              double negligible);

}  // namespace colonnade
