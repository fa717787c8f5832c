// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/evaluation/trajectory_score.hpp"

namespace colonnade {

/// An estimated pose and the true one at the same time.
struct PosePair {
  double stamp_s = 0.0;
  Eigen::Isometry3d T_estimate_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_truth_body = Eigen::Isometry3d::Identity();
};

std::vector<PosePair> matchPoses(const Trajectory& estimate, const Trajectory& truth,
                                 const EvaluationOptions& options);

}  // namespace colonnade
