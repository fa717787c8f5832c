// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/axis_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

void AxisTracker::step(const Frame& frame, const std::vector<WallDirection>& walls,
                       double noise_scale, EkfSlam& filter, std::vector<Event>& events) {
  if (!options_.enabled) return;
  bool considered = false;  // one frame counts once, however many parallel walls it shows
  for (const WallDirection& wall : walls) {
    if (wall.length_m < options_.min_wall_m) continue;
    const double sigma = std::hypot(wall.sigma, options_.parallel_sigma);
    const auto nearest = nearestAxis(wall.direction, sigma, filter);
    if (nearest && nearest->apart <= options_.merge) {
      filter.updateAxis(nearest->axis, wall.direction, sigma, noise_scale);
    } else if (!considered) {
      considered = true;
      consider(frame, wall, sigma, filter, events);
    }
  }
}

std::optional<AxisTracker::Nearest> AxisTracker::nearestAxis(double direction, double sigma,
                                                             const EkfSlam& filter) const {
  std::optional<Nearest> nearest;
  for (const LandmarkId axis : axes_) {
    const auto innovation = filter.axisInnovation(axis, direction, sigma);
    if (!innovation) continue;
    const double apart = std::abs(innovation->nu(0));
    if (!nearest || apart < nearest->apart) nearest = Nearest{axis, apart};
  }
  return nearest;
}

void AxisTracker::consider(const Frame& frame, const WallDirection& wall, double sigma,
                           EkfSlam& filter, std::vector<Event>& events) {
  const double direction = filter.pose().phi + wall.direction;
  if (!candidate_world_ ||
      std::abs(wrapQuarterTurn(direction - *candidate_world_)) > 0.5 * options_.merge) {
    candidate_world_ = direction;
    sightings_ = 0;
  }
  if (++sightings_ < options_.sightings) return;
  axes_.push_back(filter.addAxis(wall.direction, sigma));
  candidate_world_.reset();
  events.push_back({frame.stamp_s, frame.index, "axis", axes_.back(), "wall direction"});
}

}  // namespace colonnade
