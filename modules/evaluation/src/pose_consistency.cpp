// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr double kChiSquared3At95 = 7.815;
constexpr double kSameRow_s = 1e-5;  ///< the stamps of files carry microseconds

const Eigen::Matrix3d* covarianceAt(const std::vector<StampedCovariance>& covariances,
                                    double stamp_s) {
  const auto row =
      std::lower_bound(covariances.begin(), covariances.end(), stamp_s - kSameRow_s,
                       [](const auto& entry, double stamp) { return entry.stamp_s < stamp; });
  if (row == covariances.end() || row->stamp_s > stamp_s + kSameRow_s) return nullptr;
  return &row->covariance;
}

/// Where both worlds are one already nothing is laid on anything; else the first matched poses are,
/// if the file says how sure the estimate was there.
std::optional<Anchor> anchorOf(const PosePair& first, Alignment alignment,
                               const Eigen::Matrix3d* covariance) {
  Anchor anchor;
  if (alignment == Alignment::kNone) return anchor;
  if (!covariance) return std::nullopt;
  anchor.T_estimate_body = planarPart(first.T_estimate_body);
  anchor.T_truth_estimate = planarPart(first.T_truth_body * first.T_estimate_body.inverse());
  anchor.covariance = *covariance;
  return anchor;
}

std::optional<double> squaredError(const PosePair& pair, const Eigen::Isometry3d& T_estimate_truth,
                                   const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  if (factor.info() != Eigen::Success || factor.matrixLLT()(2, 2) <= 0.0) return std::nullopt;
  const Pose2 truth = planarPart(T_estimate_truth * pair.T_truth_body);
  const Pose2 estimate = planarPart(pair.T_estimate_body);
  Eigen::Vector3d error = estimate.vector() - truth.vector();
  error.z() = wrapAngle(error.z());
  const double nees = factor.matrixL().solve(error).squaredNorm();
  return std::isfinite(nees) ? std::optional(nees) : std::nullopt;
}

std::string refusal(const Anchor& anchor, double late_s, std::size_t judged, std::size_t doubtful) {
  const auto& P = anchor.covariance;
  return "at the first pose with truth, " + formatFixed(late_s, 2) +
         " s after its beginning, the estimate was already unsure by " +
         formatFixed(1000.0 * std::sqrt(std::max(P(0, 0), P(1, 1))), 1) + " mm and " +
         formatFixed(degrees(std::sqrt(P(2, 2))), 3) +
         " degrees; too much to lay the worlds on each other there (" + std::to_string(doubtful) +
         " of " + std::to_string(judged + doubtful) +
         " poses could not be judged); use truth from the beginning, or --align none if both are "
         "in one world";
}

}  // namespace

void scoreConsistency(const std::vector<PosePair>& pairs,
                      const std::vector<StampedCovariance>& covariances, TrajectoryScore& score) {
  if (covariances.empty()) return;
  const PosePair& first = pairs.front();
  score.anchor = anchorOf(first, score.alignment, covarianceAt(covariances, first.stamp_s));
  if (!score.anchor) {
    score.nees_refused =
        "no covariance at " + formatFixed(first.stamp_s, 3) +
        " s, the first pose with truth: how sure the estimate was there is not known";
    return;
  }
  const bool one_world = score.alignment == Alignment::kNone;
  const Eigen::Isometry3d T_estimate_truth =
      one_world ? Eigen::Isometry3d::Identity()
                : Eigen::Isometry3d(first.T_estimate_body * first.T_truth_body.inverse());
  double sum = 0.0;
  double within = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Matrix3d* covariance = covarianceAt(covariances, pair.stamp_s);
    if (!covariance) continue;
    const auto nees = squaredError(pair, T_estimate_truth, *covariance);
    if (!nees) continue;
    if (!score.anchor->serves(pair.T_estimate_body.translation().head<2>(), *covariance)) {
      ++score.nees_left_out;
      continue;
    }
    sum += *nees;
    within += *nees <= kChiSquared3At95 ? 1.0 : 0.0;
    ++score.nees_poses;
  }
  if (score.nees_left_out > score.nees_poses) {
    score.nees_refused = refusal(*score.anchor, first.stamp_s - covariances.front().stamp_s,
                                 score.nees_poses, score.nees_left_out);
    score.nees_poses = 0;
    return;
  }
  if (score.nees_poses == 0) {
    score.nees_refused = "no covariance fits a matched pose and is positive definite";
    return;
  }
  const auto count = static_cast<double>(score.nees_poses);
  score.nees_mean = sum / count / 3.0;
  score.nees_share_within_95 = within / count;
}

}  // namespace colonnade
