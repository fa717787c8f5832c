// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/event.hpp"
#include "colonnade/slam/observation.hpp"

namespace colonnade {

struct HallwayOptions {
  static constexpr const char* kSection = "Hallways";
  bool enabled = true;
  double parallel = radians(10.0);
  double same_side_m = 0.35;
  double reach_m = 2.5;
  double widest_m = 4.0;
  int sightings = 5;
  int break_frames = 10;
  double same_heading = radians(20.0);

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "number the hallways and find their corners");
    v.angle("parallel_deg", parallel, {1, 40}, "of a floor edge with its hallway");
    v.number("same_side_m", same_side_m, {0.05, 2}, "between sightings of one side of a hallway");
    v.number("reach_m", reach_m, {0.5, 10}, "of the near end of a floor edge ahead of the robot");
    v.number("widest_m", widest_m, {0.5, 50}, "from the robot to a side of its hallway");
    v.integer("sightings", sightings, {1, 100}, "of new floor edges that make a hallway");
    v.integer("break_frames", break_frames, {1, 1000}, "without its floor edges end a hallway");
    v.angle("same_heading_deg", same_heading, {1, 90},
            "a break within this turn is the building's doing, beyond it the robot's");
  }
};

/// A stretch between changes of direction or breaks of its floor edges.
struct Hallway {
  int number = 0;
  double direction = 0.0;  ///< of its length in the world, [0, pi)
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  double along_min_m = 0.0;  ///< seen part of its floor edges, from p_world
  double along_max_m = 0.0;
  double left_m = 0.0;   ///< of its sides from p_world across the direction; 0: not seen
  double right_m = 0.0;  ///< negative; 0: not seen

  Eigen::Vector2d along() const { return {std::cos(direction), std::sin(direction)}; }
  double acrossOf(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d a = along();
    return a.x() * (p - p_world).y() - a.y() * (p - p_world).x();
  }
};

/// Numbers hallways as the thesis of 2015 does (section 2.6, figures 30 and 31): the first floor
/// edges along the robot's way begin hallway 0; when they break, the heading is checked: about the
/// same as when they were first seen means that the hallway changes, another that the robot turned;
/// the next floor edges along its way begin the next hallway, or are known as those of a former
/// one. A landmark known from one hallway that is seen from another is a corner feature.
class HallwayTracker {
 public:
  explicit HallwayTracker(const HallwayOptions& options) : options_(options) {}
  HallwayTracker(const HallwayOptions& options, std::vector<Hallway> known)
      : options_(options), hallways_(std::move(known)) {}

  /// One frame, after the update, with the landmarks matched in it.
  void step(const Observation& seen, const std::vector<LandmarkId>& matched, const EkfSlam& filter,
            std::vector<Event>& events);
  void merge(LandmarkId kept, LandmarkId twin);

  const std::vector<Hallway>& hallways() const { return hallways_; }
  /// Index into hallways(), where the robot is.
  std::optional<std::size_t> current() const { return current_; }
  /// The hallway whose side each landmark stands nearest to; far from all, that in which it was
  /// first seen.
  void fill(LandmarkMap& map) const;

 private:
  struct Side {
    double direction = 0.0;  ///< in the world, [0, pi)
    Eigen::Vector2d p_a, p_b;
  };
  struct Sightings {
    int here = 0;
    int hallway = -1;
    bool corner = false;
  };
  std::vector<Side> sidesAlong(const Observation& seen, const EkfSlam& filter) const;
  bool belongs(const Side& side, const Hallway& hallway) const;
  void widen(Hallway& hallway, const Side& side) const;
  void enter(const Side& side, const Observation& seen, const EkfSlam& filter,
             std::vector<Event>& events);
  void findCorners(const Observation& seen, const std::vector<LandmarkId>& matched,
                   std::vector<Event>& events);

  HallwayOptions options_;
  std::vector<Hallway> hallways_;
  std::optional<std::size_t> current_;
  bool broken_ = false;
  double first_heading_ = 0.0;  ///< when the floor edges of the present hallway were first seen
  int unseen_frames_ = 0;
  std::optional<Side> next_;
  int next_sightings_ = 0;
  std::map<LandmarkId, Sightings> landmarks_;
};

}  // namespace colonnade
