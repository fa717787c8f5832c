// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

namespace colonnade {
namespace {

constexpr double kImprobable = 11.62;  ///< 99.7 % of chi-squared with 2 degrees of freedom

/// e' P^-1 e of a landmark in the estimate's world, if it may be judged there.
std::optional<double> squaredError(const LandmarkRecord& estimate, const LandmarkRecord& truth,
                                   const Anchor& anchor) {
  if (!anchor.serves(estimate.p_world, estimate.covariance)) return std::nullopt;
  const Eigen::LLT<Eigen::Matrix2d> factor(estimate.covariance);
  if (factor.info() != Eigen::Success || factor.matrixLLT()(1, 1) <= 0.0) return std::nullopt;
  const Eigen::Vector2d p_true = transform(anchor.T_truth_estimate.inverse(), truth.p_world);
  const double nees = factor.matrixL().solve(estimate.p_world - p_true).squaredNorm();
  return std::isfinite(nees) ? std::optional(nees) : std::nullopt;
}

std::vector<Candidate> candidatesOf(const LandmarkLists& lists, double gate_m) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < lists.aligned.size(); ++i)
    for (std::size_t j = 0; j < lists.truth.size(); ++j) {
      const double distance = (lists.aligned[i].p_world - lists.truth[j].p_world).norm();
      if (distance <= gate_m) candidates.push_back({i, j, std::pow(distance / gate_m, 2)});
    }
  return candidates;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

KindScore scorePoints(const LandmarkLists& lists, const LandmarkScoreOptions& options,
                      const std::optional<Anchor>& anchor) {
  const auto& [estimate, aligned, truth] = lists;
  const auto seen = [&](std::size_t j) {
    return truth[j].observations >= options.min_observations;
  };
  const auto candidates = candidatesOf(lists, options.gate_m);
  const auto truth_of = assignSeenFirst(aligned.size(), truth.size(), candidates, 1.0, seen);
  std::set<std::size_t> near_truth;
  for (const auto& candidate : candidates) near_truth.insert(candidate.estimate);

  KindScore score;
  score.estimated = aligned.size();
  std::vector<bool> found(truth.size(), false);
  std::vector<double> errors;
  double squares = 0.0;
  double nees = 0.0;
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    if (!truth_of[i]) {
      (near_truth.contains(i) ? score.duplicate_ids : score.false_ids).push_back(aligned[i].id);
      continue;
    }
    const auto& target = truth[*truth_of[i]];
    found[*truth_of[i]] = true;
    ++score.right;
    errors.push_back((aligned[i].p_world - target.p_world).norm());
    squares += errors.back() * errors.back();
    const auto squared = anchor ? squaredError(estimate[i], target, *anchor) : std::nullopt;
    if (!squared) continue;
    nees += *squared;
    ++score.nees_landmarks;
    if (*squared > kImprobable) score.improbable_ids.push_back(aligned[i].id);
  }
  score.duplicates = score.duplicate_ids.size();
  for (std::size_t j = 0; j < truth.size(); ++j) {
    if (!seen(j)) continue;
    ++score.true_seen;
    if (found[j])
      ++score.true_found;
    else
      score.missed_ids.push_back(truth[j].id);
  }
  score.position_rmse_m = rootMean(squares, static_cast<double>(errors.size()));
  if (!errors.empty()) score.position_median_m = median(errors);
  if (score.nees_landmarks > 0)
    score.nees_mean = nees / (2.0 * static_cast<double>(score.nees_landmarks));
  return score;
}

}  // namespace colonnade
