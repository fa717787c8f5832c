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

const StampedCovariance* covarianceAt(const std::vector<StampedCovariance>& covariances,
                                      double stamp_s) {
  const auto row =
      std::lower_bound(covariances.begin(), covariances.end(), stamp_s - kSameRow_s,
                       [](const auto& entry, double stamp) { return entry.stamp_s < stamp; });
  if (row == covariances.end() || row->stamp_s > stamp_s + kSameRow_s) return nullptr;
  return &*row;
}

/// A pose with its covariance in the world as it was at the start, which the covariance is about.
struct JudgedPose {
  PosePair pair;
  Eigen::Matrix3d covariance;
};
std::optional<JudgedPose> judged(const PosePair& pair,
                                 const std::vector<StampedCovariance>& covariances) {
  const StampedCovariance* row = covarianceAt(covariances, pair.stamp_s);
  if (!row) return std::nullopt;
  JudgedPose pose{pair, {}};
  pose.pair.T_estimate_body = row->T_world_origin.inverse().toIsometry3() * pair.T_estimate_body;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = row->T_world_origin.rotation().transpose();
  pose.covariance = R * row->covariance * R.transpose();
  return pose;
}

/// Where both worlds are one already nothing is laid on anything; else the first matched poses are,
/// if the file says how sure the estimate was there.
std::optional<Anchor> anchorOf(const std::optional<JudgedPose>& first, Alignment alignment) {
  Anchor anchor;
  if (alignment == Alignment::kNone) return anchor;
  if (!first) return std::nullopt;
  const auto& [pair, covariance] = *first;
  anchor.stamp_s = pair.stamp_s;
  anchor.T_estimate_body = planarPart(pair.T_estimate_body);
  anchor.T_truth_estimate = planarPart(pair.T_truth_body * pair.T_estimate_body.inverse());
  anchor.covariance = covariance;
  return anchor;
}

std::optional<double> squaredError(const JudgedPose& pose,
                                   const Eigen::Isometry3d& T_estimate_truth) {
  const auto& [pair, covariance] = pose;
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
  const auto judged_first = judged(first, covariances);
  score.anchor = anchorOf(judged_first, score.alignment);
  if (!score.anchor) {
    score.nees_refused =
        "no covariance at " + formatFixed(first.stamp_s, 3) +
        " s, the first pose with truth: how sure the estimate was there is not known";
    return;
  }
  const bool one_world = score.alignment == Alignment::kNone;
  const Eigen::Isometry3d T_estimate_truth =
      one_world
          ? Eigen::Isometry3d::Identity()
          : Eigen::Isometry3d(judged_first->pair.T_estimate_body * first.T_truth_body.inverse());
  double sum = 0.0;
  double within = 0.0;
  for (const auto& pair : pairs) {
    const auto pose = judged(pair, covariances);
    if (!pose) continue;
    const auto nees = squaredError(*pose, T_estimate_truth);
    if (!nees) continue;
    if (!score.anchor->serves(pose->pair.T_estimate_body.translation().head<2>(),
                              pose->covariance)) {
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

std::optional<Anchor> anchorOfMap(const TrajectoryScore& score, const Trajectory& final,
                                  const std::vector<StampedCovariance>& covariances) {
  if (!score.anchor || covariances.empty()) return score.anchor;
  const Anchor& then = *score.anchor;
  Pose2 T_now_then = covariances.back().T_world_origin;
  const auto same = std::find_if(final.begin(), final.end(), [&](const StampedPose& pose) {
    return std::abs(pose.stamp_s - then.stamp_s) <= kSameRow_s;
  });
  if (score.alignment != Alignment::kNone && same != final.end())
    T_now_then = planarPart(same->T_world_body) * then.T_estimate_body.inverse();
  Anchor now = then;
  now.T_truth_estimate = then.T_truth_estimate * T_now_then.inverse();
  now.T_estimate_body = T_now_then * then.T_estimate_body;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T_now_then.rotation();
  now.covariance = R * then.covariance * R.transpose();
  return now;
}

}  // namespace colonnade
