// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_memory.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kMostSights = 20;  ///< then both counts are halved
constexpr std::size_t kMostPlaces = 500;

std::optional<Eigen::Vector2d> placeOf(const Detection& edge) {
  if (edge.kind() != LandmarkKind::kPillarEdge || edge.range_m <= 0.0) return std::nullopt;
  const Measurement& m = edge.measurement;
  return m.p_robot_camera + edge.range_m * Eigen::Vector2d(std::cos(m.z[0]), std::sin(m.z[0]));
}

}  // namespace

PillarMemory::Place* PillarMemory::nearest(const Eigen::Vector2d& p_robot) {
  Place* found = nullptr;
  double least_m = options_.gate_m;
  for (Place& place : places_) {
    const double apart_m = (place.p_robot - p_robot).norm();
    if (apart_m >= least_m) continue;
    least_m = apart_m;
    found = &place;
  }
  return found;
}

/// The lower part of a pillar may be brighter than the floor behind it and the upper one darker
/// than the wall: two edges, of which the lower one ends.
bool PillarMemory::goesOnAbove(const Detections& detections, const Detection& low,
                               const Eigen::Vector2d& p_robot) const {
  constexpr double kHigher_px = 10.0;
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& other) {
    if (!other.accepted() || other.a_px.y() > low.a_px.y() - kHigher_px) return false;
    const auto p_other = placeOf(other);
    return p_other && (*p_other - p_robot).norm() < options_.gate_m;
  });
}

void PillarMemory::move(const Pose2& T_previous_robot) {
  const Pose2 T_robot_previous = T_previous_robot.inverse();
  const double way_m = T_previous_robot.translation().norm();
  for (Place& place : places_) {
    place.p_robot = transform(T_robot_previous, place.p_robot);
    place.way_m += way_m;
  }
  std::erase_if(places_, [&](const Place& place) { return place.way_m > options_.max_way_m; });
}

void PillarMemory::judge(Detections& detections, const Segmentation& segmentation,
                         const std::optional<Pose2>& T_previous_robot) {
  if (!options_.enabled) return;
  if (T_previous_robot)
    move(*T_previous_robot);
  else
    places_.clear();
  // What this frame shows, before anything is refused from memory.
  struct Sight {
    Eigen::Vector2d p_robot;
    bool low;
  };
  std::vector<Sight> sights;
  for (const Detection& edge : detections) {
    if (edge.height == UprightHeight::kUnknown) continue;
    const auto p_robot = placeOf(edge);
    if (!p_robot || segmentation.at(0.5 * (edge.a_px + edge.b_px)) == Segmentation::kMoving)
      continue;
    const bool low = edge.height == UprightHeight::kLow;
    if (!low || !goesOnAbove(detections, edge, *p_robot)) sights.push_back({*p_robot, low});
  }
  for (Detection& edge : detections) {
    if (!edge.accepted() || edge.height != UprightHeight::kUnknown) continue;
    const auto p_robot = placeOf(edge);
    const Place* const place = p_robot ? nearest(*p_robot) : nullptr;
    if (!place || place->low <= place->tall) continue;
    refuse(detections, edge, "was too low for a part of the building");
  }
  for (const Sight& sight : sights) {
    Place* place = nearest(sight.p_robot);
    if (!place) {
      if (places_.size() >= kMostPlaces)
        places_.erase(
            std::max_element(places_.begin(), places_.end(),
                             [](const Place& a, const Place& b) { return a.way_m < b.way_m; }));
      place = &places_.emplace_back();
    }
    place->p_robot = sight.p_robot;
    place->way_m = 0.0;
    ++(sight.low ? place->low : place->tall);
    if (place->low + place->tall <= kMostSights) continue;
    place->low /= 2;
    place->tall /= 2;
  }
}

}  // namespace colonnade
