// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/hallway.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr double kBeside_m = 1.0;  ///< from the seen side of a hallway to what belongs to it
constexpr int kCornerSightings = 3;

double halfTurn(double direction) {
  const double d = std::fmod(direction, kPi);
  return d < 0.0 ? d + kPi : d;
}

double apart(double a, double b) { return std::abs(std::remainder(a - b, kPi)); }

double width(const Hallway& h) {
  return h.left_m > 0.0 && h.right_m < 0.0 ? h.left_m - h.right_m : 0.0;
}

}  // namespace

void HallwayTracker::step(const Observation& seen, const std::vector<LandmarkId>& matched,
                          const EkfSlam& filter, std::vector<Event>& events) {
  if (!options_.enabled) return;
  bool holds = false;
  std::optional<Side> other;
  for (const Side& side : sidesAlong(seen, filter)) {
    if (current_ && belongs(side, hallways_[*current_])) {
      widen(hallways_[*current_], side);
      holds = true;
    } else if (apart(side.direction, filter.pose().phi) < options_.parallel) {
      other = side;
    }
  }
  unseen_frames_ = holds ? 0 : unseen_frames_ + 1;
  if (holds && broken_) broken_ = false;  // the robot only looked away
  if (current_ && !broken_ && unseen_frames_ == options_.break_frames) {
    broken_ = true;
    const double turned = std::abs(wrapAngle(filter.pose().phi - first_heading_));
    events.push_back({seen.stamp_s, seen.index, "break", std::nullopt,
                      "floor edges of hallway " + std::to_string(hallways_[*current_].number) +
                          (turned < options_.same_heading ? " end: the hallway changes"
                                                          : " left: the robot turned")});
  }
  if (!other || (current_ && !broken_)) {
    if (!other) next_sightings_ = std::max(0, next_sightings_ - 1);
  } else if (next_ && apart(next_->direction, other->direction) < options_.parallel) {
    next_ = other;
    if (++next_sightings_ >= options_.sightings) enter(*other, seen, filter, events);
  } else {
    next_ = other;
    next_sightings_ = 1;
  }
  findCorners(seen, matched, events);
}

/// Floor edges beside and before the robot, the near ones last.
std::vector<HallwayTracker::Side> HallwayTracker::sidesAlong(const Observation& seen,
                                                             const EkfSlam& filter) const {
  std::vector<Side> sides;
  for (const Detection& detection : seen.detections) {
    if (detection.kind() != LandmarkKind::kFloorEdge || !detection.accepted()) continue;
    if (detection.on_surface) continue;
    const double near = std::min(detection.p_robot_a.norm(), detection.p_robot_b.norm());
    if (std::abs(detection.measurement.z(1)) > options_.widest_m || near > options_.reach_m)
      continue;
    sides.push_back({halfTurn(filter.pose().phi + detection.measurement.z(0) + kPi / 2.0),
                     transform(filter.pose(), detection.p_robot_a),
                     transform(filter.pose(), detection.p_robot_b)});
  }
  return sides;
}

bool HallwayTracker::belongs(const Side& side, const Hallway& hallway) const {
  if (apart(side.direction, hallway.direction) > options_.parallel) return false;
  const double across = hallway.acrossOf(0.5 * (side.p_a + side.p_b));
  const double known = across > 0.0 ? hallway.left_m : hallway.right_m;
  return known == 0.0 || std::abs(across - known) < options_.same_side_m;
}

void HallwayTracker::widen(Hallway& hallway, const Side& side) const {
  const double across = hallway.acrossOf(0.5 * (side.p_a + side.p_b));
  double& known = across > 0.0 ? hallway.left_m : hallway.right_m;
  known = known == 0.0 ? across : 0.9 * known + 0.1 * across;
  for (const Eigen::Vector2d& p : {side.p_a, side.p_b}) {
    const double s = hallway.along().dot(p - hallway.p_world);
    hallway.along_min_m = std::min(hallway.along_min_m, s);
    hallway.along_max_m = std::max(hallway.along_max_m, s);
  }
}

void HallwayTracker::enter(const Side& side, const Observation& seen, const EkfSlam& filter,
                           std::vector<Event>& events) {
  next_.reset();
  next_sightings_ = 0;
  broken_ = false;
  unseen_frames_ = 0;
  first_heading_ = filter.pose().phi;
  const bool has_former = current_.has_value();
  const Hallway former = has_former ? hallways_[*current_] : Hallway{};
  const Eigen::Vector2d here = filter.pose().translation();
  const auto known = std::find_if(hallways_.begin(), hallways_.end(), [&](const Hallway& h) {
    const double a = h.along().dot(side.p_a - h.p_world);
    const double b = h.along().dot(side.p_b - h.p_world);
    return belongs(side, h) && std::max(a, b) > h.along_min_m - options_.reach_m &&
           std::min(a, b) < h.along_max_m + options_.reach_m &&
           std::abs(h.acrossOf(here)) < options_.widest_m;
  });
  std::string reason;
  if (known != hallways_.end()) {
    current_ = static_cast<std::size_t>(known - hallways_.begin());
    reason = "again in " + std::to_string(known->number);
  } else {
    Hallway hallway;
    hallway.number = hallways_.empty() ? 0 : hallways_.back().number + 1;
    hallway.direction = side.direction;
    hallway.p_world = here;
    widen(hallway, side);
    hallways_.push_back(hallway);
    current_ = hallways_.size() - 1;
    reason = "enters " + std::to_string(hallway.number);
    if (has_former) {
      const double turn = degrees(apart(former.direction, hallway.direction));
      reason += turn > degrees(options_.parallel)
                    ? ", " + formatFixed(turn, 0) + " degrees from the former one"
                    : ", parallel to the former one of width " + formatFixed(width(former), 2);
    }
  }
  events.push_back({seen.stamp_s, seen.index, "hallway", std::nullopt, reason});
}

void HallwayTracker::findCorners(const Observation& seen, const std::vector<LandmarkId>& matched,
                                 std::vector<Event>& events) {
  if (!current_ || broken_) return;
  const int number = hallways_[*current_].number;
  for (const LandmarkId id : matched) {
    const auto [at, is_new] = landmarks_.try_emplace(id, Sightings{0, number, false});
    Sightings& s = at->second;
    if (s.hallway == number || s.corner) continue;
    if (++s.here < kCornerSightings) continue;
    s.corner = true;
    events.push_back({seen.stamp_s, seen.index, "corner", id,
                      "known from hallway " + std::to_string(s.hallway) + " and seen from " +
                          std::to_string(number)});
  }
}

void HallwayTracker::merge(LandmarkId kept, LandmarkId twin) {
  const auto from = landmarks_.find(twin);
  if (from == landmarks_.end()) return;
  landmarks_.try_emplace(kept, from->second);
  landmarks_.erase(from);
}

void HallwayTracker::fill(LandmarkMap& map) const {
  for (LandmarkRecord& record : map) {
    double best = kBeside_m;
    for (const Hallway& h : hallways_) {
      if (record.direction && apart(*record.direction, h.direction) > radians(45.0)) continue;
      const double s = h.along().dot(record.p_world - h.p_world);
      const double across = h.acrossOf(record.p_world);
      const double beyond = std::max({h.along_min_m - s, s - h.along_max_m, 0.0});
      const double from_side = std::min(h.left_m > 0.0 ? std::abs(across - h.left_m) : 1e9,
                                        h.right_m < 0.0 ? std::abs(across - h.right_m) : 1e9);
      if (std::hypot(beyond, from_side) >= best) continue;
      best = std::hypot(beyond, from_side);
      record.hallway = h.number;
    }
    const auto first = landmarks_.find(record.id);
    if (record.hallway < 0 && first != landmarks_.end()) record.hallway = first->second.hallway;
  }
}

}  // namespace colonnade
