// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/landmark_score.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/error.hpp"
#include "line_score.hpp"
#include "point_score.hpp"

namespace colonnade {
namespace {

LandmarkRecord moved(const Pose2& T_truth_estimate, LandmarkRecord record) {
  const Eigen::Matrix2d R = T_truth_estimate.rotation();
  record.p_world = transform(T_truth_estimate, record.p_world);
  record.extent_a = transform(T_truth_estimate, record.extent_a);
  record.extent_b = transform(T_truth_estimate, record.extent_b);
  record.covariance = R * record.covariance * R.transpose();
  if (record.direction) *record.direction += T_truth_estimate.phi;
  return record;
}

LandmarkMap ofKind(LandmarkKind kind, const LandmarkMap& map) {
  LandmarkMap result;
  for (const auto& record : map)
    if (record.kind == kind) result.push_back(record);
  return result;
}

void addShares(KindScore& score) {
  if (score.estimated > 0)
    score.precision =
        static_cast<double>(score.right + score.further) / static_cast<double>(score.estimated);
  if (score.true_seen > 0)
    score.recall = static_cast<double>(score.true_found) / static_cast<double>(score.true_seen);
}

/// False landmarks of one upright kind that stand where the truth has the other.
std::size_t atOtherKind(const KindScore& score, const LandmarkMap& estimate,
                        const LandmarkMap& other, double gate_m) {
  const auto stands = [&](LandmarkId id) {
    const auto record = std::find_if(estimate.begin(), estimate.end(),
                                     [&](const auto& candidate) { return candidate.id == id; });
    return std::any_of(other.begin(), other.end(), [&](const auto& t) {
      return (t.p_world - record->p_world).norm() <= gate_m;
    });
  };
  return static_cast<std::size_t>(
      std::count_if(score.false_ids.begin(), score.false_ids.end(), stands));
}

}  // namespace

LandmarkScore scoreLandmarks(const LandmarkMap& estimate, const LandmarkMap& truth,
                             const Pose2& T_truth_estimate, const LandmarkScoreOptions& options,
                             const std::optional<Anchor>& anchor) {
  if (truth.empty()) throw Error("the true landmarks hold no landmark");
  LandmarkMap aligned;
  for (const auto& record : estimate) aligned.push_back(moved(T_truth_estimate, record));
  LandmarkScore score;
  score.options = options;
  for (const auto kind : {LandmarkKind::kPillarEdge, LandmarkKind::kDepthSlope}) {
    auto& kind_score = score.kinds[static_cast<std::size_t>(kind)];
    const auto found = ofKind(kind, aligned);
    const auto other =
        kind == LandmarkKind::kPillarEdge ? LandmarkKind::kDepthSlope : LandmarkKind::kPillarEdge;
    kind_score = scorePoints({ofKind(kind, estimate), found, ofKind(kind, truth)}, options, anchor);
    kind_score.other_kind = atOtherKind(kind_score, found, ofKind(other, truth), options.gate_m);
  }
  const auto floor_edge = LandmarkKind::kFloorEdge;
  score.kinds[static_cast<std::size_t>(floor_edge)] = scoreLines(
      {ofKind(floor_edge, estimate), ofKind(floor_edge, aligned), ofKind(floor_edge, truth)},
      options, anchor, score.walls);
  for (auto& kind_score : score.kinds) addShares(kind_score);
  return score;
}

}  // namespace colonnade
