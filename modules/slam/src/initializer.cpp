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

  std::vector<Detection> unknown_bearings;
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Detection& detection = detections[d];
    if (known[d] || !detection.accepted()) continue;
    if (!detection.measurement.hasRange())
      unknown_bearings.push_back(detection);
    else if (!recognise(detection, filter))
      candidates_.push_back({detection, keyOf(detection, filter.pose())});
  }
  found(frame, filter, book, events);
  foundFromBearings(frame, unknown_bearings, filter, book, events);
  std::erase_if(candidates_, [&](const auto& c) { return c.unseen > options_.patience_frames; });
  endProbation(frame, filter, book, events);
  former_stamp_s_ = frame.stamp_s;
}

bool Initializer::recognise(const Detection& detection, const EkfSlam& filter) {
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

void Initializer::foundFromBearings(const Frame& frame, const std::vector<Detection>& unknown,
                                    EkfSlam& filter, LandmarkBook& book,
                                    std::vector<Event>& events) {
  const double interval_s = frame.stamp_s - former_stamp_s_.value_or(-HUGE_VAL);
  const double noise_scale = correlatedNoiseScale(interval_s, filter.options().error_correlation_s);
  const auto step = bearings_->step(unknown, noise_scale, filter);
  for (const auto& founded : step.founded) {
    book.observe(founded.landmark, founded.detection, frame.stamp_s, filter);
    unseen_.emplace_back(founded.landmark, 0);
    events.push_back({frame.stamp_s, frame.index, "birth", founded.landmark,
                      std::string(name(founded.detection.kind())) + " by " + options_.policy +
                          " after " + std::to_string(founded.age) + " frames"});
  }
  for (const std::string& reason : step.rejected)
    events.push_back({frame.stamp_s, frame.index, "candidate rejected", std::nullopt, reason});
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
