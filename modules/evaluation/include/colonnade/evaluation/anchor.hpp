// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// How the worlds of estimate and truth are laid on each other to judge covariances, which are
/// relative to where the filter began: at one pose, the first matched one. Honest only where the
/// estimate was sure there; what it was not sure of turns and shifts everything afterwards.
struct Anchor {
  double stamp_s = 0.0;  ///< of the anchored pose
  Pose2 T_truth_estimate;
  Pose2 T_estimate_body;                                 ///< the anchored pose
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of it: x, y, phi

  /// The covariance that doubt about the anchored pose causes in a pose at `p_estimate`: a turn
  /// about the anchored pose and a shift.
  Eigen::Matrix3d doubtAt(const Eigen::Vector2d& p_estimate) const;
  /// May something with covariance P (2x2: a point; 3x3: a pose) at p_estimate be judged by this
  /// anchor? Its correlation with the anchored pose is not known. Where every standard deviation of
  /// P is ten times that of the doubt, the true covariance of the difference lies within
  /// (1 +- 0.1)^2 of P whatever the correlation, so that a squared error is right to a fifth.
  bool serves(const Eigen::Vector2d& p_estimate, const Eigen::MatrixXd& P) const;
};

}  // namespace colonnade
