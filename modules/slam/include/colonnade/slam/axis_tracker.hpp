// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/detectors/wall_direction_detector.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/event.hpp"

namespace colonnade {

struct AxisOptions {
  static constexpr const char* kSection = "Axes";
  bool enabled = true;
  double min_wall_m = 0.8;
  double parallel_sigma = radians(0.7);
  double merge = radians(5.0);
  int sightings = 5;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "let walls observe the heading");
    v.number("min_wall_m", min_wall_m, {0.2, 20}, "shortest wall used");
    v.angle("parallel_sigma_deg", parallel_sigma, {0.05, 20}, "of a wall from its axis");
    v.angle("merge_deg", merge, {0.5, 40}, "two axes nearer than this are one");
    v.integer("sightings", sightings, {1, 100}, "of a wall direction before it becomes an axis");
  }
};

/// Building axes: walls that stand parallel or square to each other observe the heading, so that it
/// does not drift along a corridor (Zhou et al., StructSLAM, IEEE TVT 2015). Several axes may
/// exist.
class AxisTracker {
 public:
  explicit AxisTracker(const AxisOptions& options, std::vector<LandmarkId> known = {})
      : options_(options), axes_(std::move(known)) {}
  /// One frame: corrects the heading by every wall along a known axis, longest wall first.
  /// noise_scale as in EkfSlam::update: a wall keeps its error from frame to frame.
  void step(const Frame& frame, const std::vector<WallDirection>& walls, double noise_scale,
            EkfSlam& filter, std::vector<Event>& events);
  const std::vector<LandmarkId>& axes() const { return axes_; }

 private:
  struct Nearest {
    LandmarkId axis{};
    double apart = 0.0;
  };
  std::optional<Nearest> nearestAxis(double direction, double sigma, const EkfSlam& filter) const;
  /// Counts a wall of no known axis, which founds one in the end.
  void consider(const Frame& frame, const WallDirection& wall, double sigma, EkfSlam& filter,
                std::vector<Event>& events);

  AxisOptions options_;
  std::vector<LandmarkId> axes_;
  std::optional<double> candidate_world_;  ///< direction of the wall that may found the next axis
  int sightings_ = 0;
};

}  // namespace colonnade
