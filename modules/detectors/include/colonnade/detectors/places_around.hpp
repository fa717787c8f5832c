// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/detection.hpp"

namespace colonnade {

/// Where a pillar edge with a range stands, in the robot's axes.
inline std::optional<Eigen::Vector2d> placeOf(const Detection& edge) {
  if (edge.kind() != LandmarkKind::kPillarEdge || edge.range_m <= 0.0) return std::nullopt;
  const Measurement& m = edge.measurement;
  return m.p_robot_camera + edge.range_m * Eigen::Vector2d(std::cos(m.z[0]), std::sin(m.z[0]));
}

/// Places around the robot, carried along by its motion, and what was seen at each.
template <class Seen>
class PlacesAround {
 public:
  struct Place {
    Eigen::Vector2d p_robot;
    double way_m = 0.0;  ///< of the robot since the last sight
    Seen seen;
  };

  /// gate_m: between two sights of one place; max_way_m: after which a place is forgotten, since
  /// odometry drifts; of more than `most` places that unseen for the longest way goes.
  PlacesAround(double gate_m, double max_way_m, std::size_t most)
      : gate_m_(gate_m), max_way_m_(max_way_m), most_(most) {}

  void clear() { places_.clear(); }

  void move(const Pose2& T_previous_robot) {
    const Pose2 T_robot_previous = T_previous_robot.inverse();
    const double way_m = T_previous_robot.translation().norm();
    for (Place& place : places_) {
      place.p_robot = transform(T_robot_previous, place.p_robot);
      place.way_m += way_m;
    }
    std::erase_if(places_, [&](const Place& place) { return place.way_m > max_way_m_; });
  }

  /// Nothing where none is within the gate.
  Place* nearest(const Eigen::Vector2d& p_robot) {
    Place* found = nullptr;
    double least_m = gate_m_;
    for (Place& place : places_) {
      const double apart_m = (place.p_robot - p_robot).norm();
      if (apart_m >= least_m) continue;
      least_m = apart_m;
      found = &place;
    }
    return found;
  }

  /// What was seen at the place that is seen again now, or for the first time.
  Seen& sight(const Eigen::Vector2d& p_robot) {
    Place* place = nearest(p_robot);
    if (!place) {
      if (places_.size() >= most_)
        places_.erase(
            std::max_element(places_.begin(), places_.end(),
                             [](const Place& a, const Place& b) { return a.way_m < b.way_m; }));
      place = &places_.emplace_back();
    }
    place->p_robot = p_robot;
    place->way_m = 0.0;
    return place->seen;
  }

 private:
  double gate_m_;
  double max_way_m_;
  std::size_t most_;
  std::vector<Place> places_;
};

}  // namespace colonnade
