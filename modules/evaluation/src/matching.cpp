// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "matching.hpp"

#include <algorithm>
#include <optional>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

std::string span(const Trajectory& trajectory) {
  return formatFixed(trajectory.front().stamp_s, 3) + " to " +
         formatFixed(trajectory.back().stamp_s, 3) + " s";
}

Eigen::Isometry3d interpolate(const StampedPose& a, const StampedPose& b, double stamp_s) {
  const double share = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
  const Eigen::Quaterniond q_a(a.T_world_body.linear());
  const Eigen::Quaterniond q_b(b.T_world_body.linear());
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = q_a.slerp(share, q_b).toRotationMatrix();
  result.translation() =
      (1.0 - share) * a.T_world_body.translation() + share * b.T_world_body.translation();
  return result;
}

std::optional<Eigen::Isometry3d> truthAt(const Trajectory& truth, double stamp_s,
                                         const EvaluationOptions& options) {
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), stamp_s,
                       [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  const bool has_after = after != truth.end();
  const bool has_before = after != truth.begin();
  const double to_after = has_after ? after->stamp_s - stamp_s : 1e300;
  const double to_before = has_before ? stamp_s - (after - 1)->stamp_s : 1e300;
  if (has_after && has_before &&
      to_after + to_before <= options.max_truth_gap_s + options.same_stamp_s)
    return interpolate(*(after - 1), *after, stamp_s);
  if (std::min(to_after, to_before) > options.same_stamp_s) return std::nullopt;
  return to_after <= to_before ? after->T_world_body : (after - 1)->T_world_body;
}

}  // namespace

std::vector<PosePair> matchPoses(const Trajectory& estimate, const Trajectory& truth,
                                 const EvaluationOptions& options) {
  if (estimate.empty()) throw Error("the estimated trajectory holds no pose");
  if (truth.empty()) throw Error("the ground truth holds no pose");
  std::vector<PosePair> pairs;
  for (const auto& pose : estimate)
    if (const auto T_truth_body = truthAt(truth, pose.stamp_s, options))
      pairs.push_back({pose.stamp_s, pose.T_world_body, *T_truth_body});
  if (!pairs.empty()) return pairs;
  if (estimate.back().stamp_s < truth.front().stamp_s ||
      truth.back().stamp_s < estimate.front().stamp_s)
    throw Error("estimate and ground truth do not overlap in time: the estimate spans " +
                span(estimate) + ", the truth " + span(truth));
  throw Error("no estimated pose has ground truth beside it: the estimate spans " + span(estimate) +
              ", the truth " + span(truth) + ", and truth is not interpolated over gaps above " +
              formatDouble(options.max_truth_gap_s, 3) + " s");
}

}  // namespace colonnade
