// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/trajectory_score.hpp"

#include <algorithm>
#include <cmath>

#include "alignment.hpp"
#include "colonnade/base/angle.hpp"
#include "matching.hpp"
#include "pose_consistency.hpp"
#include "relative_error.hpp"

namespace colonnade {
namespace {

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

SpanScore compareSpans(const Trajectory& estimate, const Trajectory& truth) {
  SpanScore span;
  const double begin = std::max(estimate.front().stamp_s, truth.front().stamp_s);
  const double end = std::min(estimate.back().stamp_s, truth.back().stamp_s);
  const auto share = [&](const Trajectory& whole) {
    const double length = whole.back().stamp_s - whole.front().stamp_s;
    return length > 0.0 ? std::max(0.0, end - begin) / length : 1.0;
  };
  span.truth_starts_after_s = truth.front().stamp_s - estimate.front().stamp_s;
  span.truth_ends_before_s = estimate.back().stamp_s - truth.back().stamp_s;
  span.estimate_in_truth = share(estimate);
  span.truth_in_estimate = share(truth);
  return span;
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
  score.span = compareSpans(estimate, truth);
  scoreConsistency(pairs, covariances, score);
  return score;
}

}  // namespace colonnade
