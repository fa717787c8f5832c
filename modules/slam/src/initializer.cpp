// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/initializer.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

/// Where a detection with range lies in the world: a point, or a line by the foot of the normal
/// from the camera and its direction.
Eigen::Vector3d keyOf(const Detection& detection, const Pose2& T_world_robot) {
  const Measurement& m = detection.measurement;
  if (m.kind != LandmarkKind::kFloorEdge) {
    const BlockVector p = pointFromRange(T_world_robot, m).block;
    return {p(0), p(1), 0.0};
  }
  const BlockVector line = lineFromFloor(T_world_robot, m).block;
  const Eigen::Vector2d normal(std::cos(line(2)), std::sin(line(2)));
  const Eigen::Vector2d foot = line.head<2>() + line(3) * normal;
  return {foot.x(), foot.y(), line(2)};
}

bool samePlace(LandmarkKind kind, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               const InitializationOptions& options) {
  const Eigen::Vector2d apart = a.head<2>() - b.head<2>();
  if (kind != LandmarkKind::kFloorEdge) return apart.norm() < options.same_place_m;
  const double turn = std::abs(wrapAngle(a(2) - b(2)));
  if (std::min(turn, kPi - turn) > options.same_direction) return false;
  const Eigen::Vector2d normal(std::cos(b(2)), std::sin(b(2)));
  return std::abs(apart.dot(normal)) < options.same_place_m;
}

}  // namespace

void Initializer::step(const Frame& frame, const Detections& detections,
                       const Association& association, EkfSlam& filter, LandmarkBook& book,
                       std::vector<Event>& events) {
  std::vector<bool> known = association.near_landmark;
  for (const std::size_t d : association.detection_of_match) known[d] = true;
  for (Candidate& candidate : candidates_) ++candidate.unseen;
  for (BearingCandidate& candidate : bearings_) {
    ++candidate.unseen;
    ++candidate.age;
  }

  std::optional<LandmarkId> clone;  // one for all bearings first seen in this frame
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Detection& detection = detections[d];
    if (known[d] || !detection.accepted()) continue;
    if (detection.measurement.hasRange()) {
      if (!stepCandidate(detection, filter))
        candidates_.push_back({detection, keyOf(detection, filter.pose())});
    } else if (!stepBearing(detection, filter) &&
               static_cast<int>(bearings_.size()) < options_.max_bearing_candidates) {
      if (!clone) clone = filter.addPoseClone();
      bearings_.push_back({*clone, detection.measurement, detection, filter.pose()});
    }
  }
  found(frame, filter, book, events);
  foundFromBearings(frame, filter, book, events);
  dropStale(filter);
  endProbation(frame, filter, book, events);
}

bool Initializer::stepCandidate(const Detection& detection, const EkfSlam& filter) {
  const Eigen::Vector3d key = keyOf(detection, filter.pose());
  for (Candidate& candidate : candidates_) {
    if (candidate.unseen == 0 || candidate.last.kind() != detection.kind() ||
        candidate.last.appearance.gradient_sign != detection.appearance.gradient_sign ||
        !samePlace(detection.kind(), key, candidate.key, options_))
      continue;
    candidate.last = detection;
    candidate.key = key;
    candidate.unseen = 0;
    ++candidate.sightings;
    return true;
  }
  return false;
}

bool Initializer::stepBearing(const Detection& detection, const EkfSlam& filter) {
  for (BearingCandidate& candidate : bearings_) {
    const double turn = wrapAngle(filter.pose().phi - candidate.T_world_robot_last.phi);
    const double moved =
        wrapAngle(detection.measurement.z(0) + turn - candidate.last.measurement.z(0));
    if (candidate.unseen == 0 || std::abs(moved) > options_.same_bearing * candidate.unseen ||
        candidate.last.appearance.gradient_sign != detection.appearance.gradient_sign)
      continue;
    candidate.last = detection;
    candidate.T_world_robot_last = filter.pose();
    candidate.unseen = 0;
    ++candidate.sightings;
    return true;
  }
  return false;
}

void Initializer::found(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                        std::vector<Event>& events) {
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    if (candidate.unseen > 0 || candidate.sightings < options_.sightings) return false;
    if (const auto id = filter.addLandmark(candidate.last.measurement)) {
      book.observe(*id, candidate.last, frame.stamp_s, filter);
      unseen_.emplace_back(*id, 0);
      events.push_back({frame.stamp_s, frame.index, "birth", id, name(candidate.last.kind())});
    }
    return true;
  });
}

void Initializer::foundFromBearings(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                                    std::vector<Event>& events) {
  std::vector<LandmarkId> released;
  std::erase_if(bearings_, [&](const BearingCandidate& candidate) {
    if (candidate.unseen > 0 || candidate.sightings < options_.bearing_sightings) return false;
    const auto seen = filter.parallax(candidate.clone, candidate.first, candidate.last.measurement);
    if (!seen || seen->baseline_m < options_.min_baseline_m ||
        std::abs(seen->angle) < options_.min_parallax)
      return false;
    released.push_back(candidate.clone);
    // A ray that does not meet the first one in front of both cameras was no landmark.
    if (seen->inverse_depth < 2.0 * seen->inverse_depth_sigma) return true;
    if (const auto id =
            filter.addLandmark(candidate.clone, candidate.first, candidate.last.measurement)) {
      book.observe(*id, candidate.last, frame.stamp_s, filter);
      unseen_.emplace_back(*id, 0);
      events.push_back({frame.stamp_s, frame.index, "birth", id, "pillar by parallax"});
    }
    return true;
  });
  for (const LandmarkId clone : released) releaseClone(clone, filter);
}

void Initializer::dropStale(EkfSlam& filter) {
  std::erase_if(candidates_, [&](const auto& c) { return c.unseen > options_.patience_frames; });
  const auto isStale = [&](const BearingCandidate& c) {
    return c.unseen > options_.patience_frames || c.age > options_.bearing_lifetime_frames;
  };
  std::vector<LandmarkId> released;
  for (const BearingCandidate& candidate : bearings_)
    if (isStale(candidate)) released.push_back(candidate.clone);
  std::erase_if(bearings_, isStale);
  for (const LandmarkId clone : released) releaseClone(clone, filter);
}

void Initializer::releaseClone(LandmarkId clone, EkfSlam& filter) {
  const bool needed = std::any_of(bearings_.begin(), bearings_.end(),
                                  [&](const auto& c) { return c.clone == clone; });
  if (!needed) filter.remove(clone);
}

void Initializer::endProbation(const Frame& frame, EkfSlam& filter, LandmarkBook& book,
                               std::vector<Event>& events) {
  std::erase_if(unseen_, [&](auto& young) {
    const Evidence& evidence = filter.evidence(young.first);
    if (evidence.observations >= options_.probation_sightings) {
      events.push_back({frame.stamp_s, frame.index, "confirmation", young.first, ""});
      return true;
    }
    young.second = evidence.last_stamp_s == frame.stamp_s ? 0 : young.second + 1;
    if (young.second <= options_.probation_frames) return false;
    filter.remove(young.first);
    book.forget(young.first);
    events.push_back({frame.stamp_s, frame.index, "purged", young.first, "too few sightings"});
    return true;
  });
}

}  // namespace colonnade
