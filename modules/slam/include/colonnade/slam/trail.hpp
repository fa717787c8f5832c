// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {

struct TrailOptions {
  static constexpr const char* kSection = "Trail";
  bool enabled = true;
  double distance_m = 2.0;
  double turn = radians(45.0);
  int max_poses = 200;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "keep former poses in the state, so that later evidence moves them");
    v.number("distance_m", distance_m, {0.1, 100}, "between kept poses");
    v.angle("turn_deg", turn, {5, 360}, "between kept poses");
    v.integer("max_poses", max_poses, {2, 10000},
              "kept; beyond that every second one goes and the distance doubles");
  }
};

/// Where the robot was, as it is known now: every few metres a pose stays in the filter's state and
/// gets its share of every later correction, loop closings above all. Frames between two of them
/// are carried along; what their two ends disagree by is spread over the way between.
class Trail {
 public:
  explicit Trail(const TrailOptions& options) : options_(options) {}
  /// One frame, after the update.
  void step(double stamp_s, EkfSlam& filter);
  bool holds(LandmarkId clone) const {
    return std::find(nodes_.begin(), nodes_.end(), clone) != nodes_.end();
  }

  /// From the robot to the nearest kept pose that lies at least `young_m` of way back; infinite
  /// when there is none.
  double distanceToFormer(const EkfSlam& filter, double young_m) const;

  struct StampedPose2 {
    double stamp_s = 0.0;
    Pose2 T_world_robot;
  };
  /// All frames so far.
  std::vector<StampedPose2> poses(const EkfSlam& filter) const;

 private:
  struct Entry {
    double stamp_s = 0.0;
    std::size_t node = 0;
    Pose2 T_node_robot;
    double way_m = 0.0;  ///< from the start
  };
  void thin(EkfSlam& filter);

  TrailOptions options_;
  std::vector<LandmarkId> nodes_;  ///< pose clones of the filter
  std::vector<Entry> entries_;
  /// The robot at each node but the first, as seen from the node before, when it was added.
  std::vector<Pose2> T_before_node_;
  std::vector<double> node_way_m_;
  double distance_m_ = 0.0;
  double way_m_ = 0.0;
  Pose2 T_world_former_;
};

}  // namespace colonnade
