// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/trajectory_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "alignment.hpp"
#include "colonnade/base/angle.hpp"
#include "matching.hpp"
#include "relative_error.hpp"

namespace colonnade {
namespace {

constexpr double kChiSquared3At95 = 7.815;
constexpr double kSameRow_s = 1e-5;  ///< the stamps of files carry microseconds

void scoreAbsoluteErrors(const std::vector<PosePair>& pairs, TrajectoryScore& score) {
  double sum_position = 0.0;
  double sum_heading = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Isometry3d T_truth_body = score.T_truth_estimate * pair.T_estimate_body;
    Eigen::Vector3d error = T_truth_body.translation() - pair.T_truth_body.translation();
    if (score.alignment == Alignment::kSe2) error.z() = 0.0;
    sum_position += error.squaredNorm();
    score.ate_max_m = std::max(score.ate_max_m, error.norm());
    sum_heading += std::pow(planarPart(pair.T_truth_body.inverse() * T_truth_body).phi, 2);
  }
  const auto count = static_cast<double>(pairs.size());
  score.ate_rmse_m = std::sqrt(sum_position / count);
  score.heading_rmse_deg = degrees(std::sqrt(sum_heading / count));
}

double coveredTime(const std::vector<PosePair>& pairs, double max_step_s) {
  double covered = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const double step = pairs[i].stamp_s - pairs[i - 1].stamp_s;
    if (step <= max_step_s) covered += step;
  }
  return covered;
}

void scoreConsistency(const std::vector<PosePair>& pairs,
                      const std::vector<StampedCovariance>& covariances, TrajectoryScore& score) {
  const Eigen::Isometry3d T_estimate_truth =
      pairs.front().T_estimate_body * pairs.front().T_truth_body.inverse();
  double sum = 0.0;
  double within = 0.0;
  auto row = covariances.begin();
  for (const auto& pair : pairs) {
    while (row != covariances.end() && row->stamp_s < pair.stamp_s - kSameRow_s) ++row;
    if (row == covariances.end()) break;
    if (row->stamp_s > pair.stamp_s + kSameRow_s) continue;
    const Eigen::LLT<Eigen::Matrix3d> factor(row->covariance);
    if (factor.info() != Eigen::Success || factor.matrixLLT()(2, 2) <= 0.0) continue;
    const Pose2 truth = planarPart(T_estimate_truth * pair.T_truth_body);
    const Pose2 estimate = planarPart(pair.T_estimate_body);
    Eigen::Vector3d error = estimate.vector() - truth.vector();
    error.z() = wrapAngle(error.z());
    const double nees = factor.matrixL().solve(error).squaredNorm();
    if (!std::isfinite(nees)) continue;
    sum += nees;
    within += nees <= kChiSquared3At95 ? 1.0 : 0.0;
    ++score.nees_poses;
  }
  if (score.nees_poses == 0) return;
  const auto count = static_cast<double>(score.nees_poses);
  score.nees_mean = sum / count / 3.0;
  score.nees_share_within_95 = within / count;
}

}  // namespace

const DistanceError* TrajectoryScore::rpeOver(double length_m) const {
  const auto found = std::find_if(rpe.begin(), rpe.end(), [&](const DistanceError& error) {
    return error.length_m == length_m;
  });
  return found == rpe.end() ? nullptr : &*found;
}

TrajectoryScore evaluateTrajectory(const Trajectory& estimate, const Trajectory& truth,
                                   const EvaluationOptions& options,
                                   const std::vector<StampedCovariance>& covariances) {
  const auto pairs = matchPoses(estimate, truth, options);
  TrajectoryScore score;
  score.alignment = options.alignment;
  score.matched = pairs.size();
  score.estimated = estimate.size();
  score.T_truth_estimate = fitAlignment(pairs, options.alignment);
  scoreAbsoluteErrors(pairs, score);
  scoreRelativeErrors(pairs, options, score);
  const double span = truth.back().stamp_s - truth.front().stamp_s;
  score.coverage = span > 0.0 ? std::min(1.0, coveredTime(pairs, options.max_step_s) / span) : 1.0;
  scoreConsistency(pairs, covariances, score);
  return score;
}

}  // namespace colonnade
