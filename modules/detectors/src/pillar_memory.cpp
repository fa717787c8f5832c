// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_memory.hpp"

#include <algorithm>

namespace colonnade {
namespace {

constexpr int kMostSights = 20;  ///< then both counts are halved
constexpr std::size_t kMostPlaces = 500;

}  // namespace

PillarMemory::PillarMemory(const PillarMemoryOptions& options)
    : options_(options), places_(options.gate_m, options.max_way_m, kMostPlaces) {}

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

void PillarMemory::judge(Detections& detections, const Segmentation& segmentation,
                         const std::optional<Pose2>& T_previous_robot) {
  if (!options_.enabled) return;
  if (T_previous_robot)
    places_.move(*T_previous_robot);
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
    const auto* const place = p_robot ? places_.nearest(*p_robot) : nullptr;
    if (!place || place->seen.low <= place->seen.tall) continue;
    refuse(detections, edge, "was too low for a part of the building");
  }
  for (const Sight& sight : sights) {
    Heights& heights = places_.sight(sight.p_robot);
    ++(sight.low ? heights.low : heights.tall);
    if (heights.low + heights.tall <= kMostSights) continue;
    heights.low /= 2;
    heights.tall /= 2;
  }
}

}  // namespace colonnade
