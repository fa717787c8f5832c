// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/association.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

struct Pairing {
  std::size_t detection;
  LandmarkId landmark;
  double distance2;
};

/// How far the seen part of a floor edge lies from the part known so far, along the line.
double gapAlong(const Block& block, const EkfSlam& filter, const Detection& detection) {
  const BlockVector y = filter.state().values(block);
  const Eigen::Vector2d m(std::cos(y(2)), std::sin(y(2)));
  const Eigen::Vector2d along(-m.y(), m.x());
  const Eigen::Vector2d foot = y.head<2>() + y(3) * m;
  const double a = along.dot(transform(filter.pose(), detection.p_robot_a) - foot);
  const double b = along.dot(transform(filter.pose(), detection.p_robot_b) - foot);
  return std::max(std::min(a, b) - block.evidence.along_max_m,
                  block.evidence.along_min_m - std::max(a, b));
}

int degreesOfFreedom(const std::vector<Match>& matches) {
  Eigen::Index sum = 0;
  for (const Match& match : matches) sum += match.measurement.z.size();
  return static_cast<int>(sum);
}

}  // namespace

Association Associator::match(const Detections& detections, const EkfSlam& filter,
                              const LandmarkBook& book) const {
  Association result;
  result.near_landmark.assign(detections.size(), false);
  std::vector<Pairing> pairings;
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Detection& detection = detections[d];
    if (!detection.accepted()) continue;
    for (const Block& block : filter.state().blocks) {
      if (!block.isLandmark() || block.landmark_kind != detection.kind() ||
          !book.looksLike(block.id, detection))
        continue;
      if (block.block_kind == BlockKind::kFloorLine &&
          gapAlong(block, filter, detection) > options_.floor_edge_gap_m)
        continue;
      const auto innovation = filter.innovation(block.id, detection.measurement);
      if (!innovation) continue;
      const double gate = chiSquareQuantile(filter.options().gate_probability,
                                            static_cast<int>(innovation->nu.size()));
      if (innovation->distance2 < options_.near_factor * options_.near_factor * gate)
        result.near_landmark[d] = true;
      if (innovation->within_gate) pairings.push_back({d, block.id, innovation->distance2});
    }
  }
  std::stable_sort(pairings.begin(), pairings.end(),
                   [](const auto& a, const auto& b) { return a.distance2 < b.distance2; });

  std::vector<bool> detection_used(detections.size(), false);
  std::vector<LandmarkId> landmarks_used;
  for (const Pairing& pairing : pairings) {
    if (detection_used[pairing.detection] || std::find(landmarks_used.begin(), landmarks_used.end(),
                                                       pairing.landmark) != landmarks_used.end())
      continue;
    detection_used[pairing.detection] = true;
    landmarks_used.push_back(pairing.landmark);
    result.matches.push_back({pairing.landmark, detections[pairing.detection].measurement});
    result.detection_of_match.push_back(pairing.detection);
  }

  // The matches stand in the order of their distance, so the last one is the worst.
  while (result.matches.size() > 1) {
    const auto joint = filter.jointDistance2(result.matches);
    if (joint &&
        *joint <= chiSquareQuantile(options_.joint_probability, degreesOfFreedom(result.matches)))
      break;
    result.matches.pop_back();
    result.detection_of_match.pop_back();
    ++result.refused_jointly;
  }
  return result;
}

}  // namespace colonnade
