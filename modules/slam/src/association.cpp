// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/association.hpp"

#include <algorithm>
#include <cmath>

#include "association/pairing.hpp"
#include "colonnade/base/angle.hpp"
#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

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

double gateProbability(LandmarkKind kind, const AssociationOptions& options) {
  switch (kind) {
    case LandmarkKind::kPillarEdge:
      return options.pillar_probability;
    case LandmarkKind::kFloorEdge:
      return options.floor_edge_probability;
    case LandmarkKind::kDepthSlope:
      return options.depth_slope_probability;
  }
  return 0.0;
}

/// How many detections may be of something else than a landmark they were matched with: as many as
/// `options.clutter` has it of those that nothing explains, and of the one in question.
class Clutter {
 public:
  Clutter(const Detections& detections, const std::vector<bool>& explained,
          const AssociationOptions& options)
      : share_(options.clutter) {
    for (std::size_t i = 0; i < detections.size(); ++i)
      if (detections[i].accepted() && !explained[i]) ++unexplained_[detections[i].kind()];
  }
  /// The logarithm of how many like this one lie in one unit of what it measures.
  double logDensity(const Detection& detection) const {
    constexpr double kView = 1.0;             // rad
    constexpr double kReach_m = 5.0;          // of ranges
    constexpr double kFloorView = 3.0 * kPi;  // rad m: all directions, 3 m away
    const double view = detection.kind() == LandmarkKind::kFloorEdge ? kFloorView
                        : detection.measurement.hasRange()           ? kView * kReach_m
                                                                     : kView;
    const auto found = unexplained_.find(detection.kind());
    const int count = 1 + (found == unexplained_.end() ? 0 : found->second);
    return std::log(share_ * count / view);
  }

 private:
  double share_;
  std::map<LandmarkKind, int> unexplained_;
};

/// What lies around one detection.
struct Nearby {
  std::vector<Pairing> pairings;
  bool near = false;    ///< a landmark so near that it may be it
  bool unlike = false;  ///< within the gate of one, kept from it by its looks
};

Nearby lookAround(std::size_t index, const Detection& detection, const EkfSlam& filter,
                  const LandmarkBook& book, const AssociationOptions& options) {
  Nearby nearby;
  for (const Block& block : filter.state().blocks) {
    if (!block.isLandmark() || block.evidence.hypothesis ||
        block.landmark_kind != detection.kind() || book.isAsleep(block.id) ||
        !book.looksLike(block, detection, filter))
      continue;
    if (block.block_kind == BlockKind::kFloorLine &&
        gapAlong(block, filter, detection) > options.floor_edge_gap_m)
      continue;
    const auto innovation = filter.innovation(block.id, detection.measurement);
    if (!innovation) continue;
    const auto numbers = static_cast<int>(innovation->nu.size());
    const double gate = chiSquareQuantile(gateProbability(detection.kind(), options), numbers);
    if (innovation->distance2 < options.near_factor * options.near_factor * gate)
      nearby.near = true;
    if (!innovation->within_gate || innovation->distance2 > gate) continue;
    double looks = 0.0;
    if (const LandmarkLooks* former = book.looks(block.id);
        former && options.looks_probability < 1.0) {
      const auto difference =
          former->difference(LandmarkBook::fromFirstSide(block, detection, filter),
                             options.colour_sigma, options.width_sigma);
      looks = difference.distance2;
      if (difference.numbers > 0 &&
          looks > chiSquareQuantile(options.looks_probability, difference.numbers)) {
        nearby.unlike = true;
        continue;
      }
    }
    nearby.pairings.push_back(
        {index, block.id, innovation->distance2, innovation->distance2 + looks});
  }
  return nearby;
}

JointPairings join(std::vector<Pairing> pairings, const Detections& detections,
                   const EkfSlam& filter) {
  std::vector<Match> matches;
  JointPairings joint;
  Eigen::Index row = 0;
  for (const Pairing& pairing : pairings) {
    matches.push_back({pairing.landmark, detections[pairing.detection].measurement});
    joint.first.push_back(row);
    joint.size.push_back(matches.back().measurement.z.size());
    row += joint.size.back();
  }
  auto innovation = filter.jointInnovation(matches);
  joint.pairings = std::move(pairings);
  joint.nu = std::move(innovation.nu);
  joint.S = std::move(innovation.S);
  return joint;
}

/// A set that passes the joint chi-square test.
std::vector<std::size_t> compatible(const JointPairings& joint,
                                    const std::vector<std::size_t>& nearest, bool many,
                                    const AssociationOptions& options) {
  std::vector<std::size_t> chosen = nearest;
  if (many)
    chosen = consensusPairings(joint, options.joint_probability);
  else if (options.method == "jcbb")
    chosen = jointPairings(joint, options.joint_probability, options.joint_nodes);
  // jcbb's set passes already; of any other the dearest is dropped until the rest passes.
  const auto cost = [&](std::size_t i) { return joint.pairings[i].cost; };
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  while (chosen.size() > 1 &&
         jointDistance2(joint, chosen) >
             chiSquareQuantile(options.joint_probability, degreesOfFreedom(joint, chosen)))
    chosen.pop_back();
  return chosen;
}

}  // namespace

Association Associator::match(const Detections& detections, const EkfSlam& filter,
                              const LandmarkBook& book) const {
  Association result;
  result.near_landmark.assign(detections.size(), false);
  std::vector<Pairing> pairings;
  for (std::size_t d = 0; d < detections.size(); ++d) {
    if (!detections[d].accepted()) continue;
    const Nearby nearby = lookAround(d, detections[d], filter, book, options_);
    result.near_landmark[d] = nearby.near;
    pairings.insert(pairings.end(), nearby.pairings.begin(), nearby.pairings.end());
    if (nearby.pairings.empty() && nearby.unlike) ++result.refused["looks unlike the landmark"];
    if (nearby.pairings.empty() && nearby.near && !nearby.unlike)
      ++result.refused["near a landmark, outside its gate"];
  }
  if (pairings.empty()) return result;

  JointPairings joint = join(std::move(pairings), detections, filter);
  const std::vector<std::size_t> nearest = nearestPairings(joint.pairings);
  const bool many = options_.consensus_matches > 0 &&
                    nearest.size() >= static_cast<std::size_t>(options_.consensus_matches);
  const std::vector<std::size_t> chosen = compatible(joint, nearest, many, options_);
  std::vector<bool> explained(detections.size(), false);
  for (const std::size_t i : chosen) explained[joint.pairings[i].detection] = true;
  const Clutter clutter(detections, explained, options_);
  for (Pairing& pairing : joint.pairings)
    pairing.log_clutter = clutter.logDensity(detections[pairing.detection]);
  for (const std::size_t i : likelierThanClutter(joint, chosen)) {
    const Pairing& pairing = joint.pairings[i];
    result.matches.push_back({pairing.landmark, detections[pairing.detection].measurement});
    result.detection_of_match.push_back(pairing.detection);
  }
  if (const std::size_t dropped = chosen.size() - result.matches.size(); dropped > 0)
    result.refused["as likely something else"] += dropped;
  std::vector<bool> counted = explained;
  for (const std::size_t i : nearest) {
    const std::size_t d = joint.pairings[i].detection;
    if (!counted[d]) ++result.refused[many ? "one-point consensus" : "joint test"];
    counted[d] = true;
  }
  for (const Pairing& pairing : joint.pairings) {
    if (!counted[pairing.detection]) ++result.refused["another detection is nearer"];
    counted[pairing.detection] = true;
  }
  return result;
}

}  // namespace colonnade
