// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/geometry_options.hpp"
#include "colonnade/detectors/refined_line.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

struct FloorEdgeOptions {
  static constexpr const char* kSection = "FloorEdges";
  bool enabled = true;
  double min_length_px = 40.0;
  double min_length_m = 0.4;
  double max_distance_m = 6.0;          ///< of the part used, from the camera
  double from_vertical = radians(8.0);  ///< lines closer to the projected vertical are left out
  double wall_height_m = 0.15;          ///< where depth is asked for the wall above the edge
  double wall_tolerance_m = 0.05;       ///< of the wall's distance, beyond noise
  double min_wall_share = 0.6;          ///< of the places with depth that must see a wall
  double parallel_m = 0.25;             ///< of parallel edges this close only the nearest counts
  double max_direction_sigma = radians(4.0);
  double max_distance_sigma_m = 0.4;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "look for floor edges");
    v.number("min_length_px", min_length_px, {10, 2000}, "shortest floor edge in the image");
    v.number("min_length_m", min_length_m, {0.05, 10}, "shortest floor edge on the floor");
    v.number("max_distance_m", max_distance_m, {0.5, 50}, "farthest part used");
    v.angle("from_vertical_deg", from_vertical, {0, 45}, "nearer to the vertical is no floor edge");
    v.number("wall_height_m", wall_height_m, {0.03, 1}, "where depth must see the wall");
    v.number("wall_tolerance_m", wall_tolerance_m, {0.01, 1}, "of the wall's place, beyond noise");
    v.number("min_wall_share", min_wall_share, {0, 1}, "places with depth that must see a wall");
    v.number("parallel_m", parallel_m, {0, 2}, "of parallel edges so close the nearest counts");
    v.angle("max_direction_sigma_deg", max_direction_sigma, {0.1, 45}, "refused beyond");
    v.number("max_distance_sigma_m", max_distance_sigma_m, {0.01, 5}, "refused beyond");
  }
};

/// Finds lines in which walls meet the floor (thesis 2015, section 2.6, for any inclination). The
/// measurement comes from the floor plane alone (camera height and tilt); depth, where there is
/// any, only confirms that a wall stands on the line or refuses it: joints of the floor, shadows,
/// reflections, upper edges of skirting boards.
class FloorEdgeDetector {
 public:
  explicit FloorEdgeDetector(const FloorEdgeOptions& options = {},
                             const GeometryOptions& geometry = {},
                             const LineRefinementOptions& lines = {})
      : options_(options), geometry_(geometry), lines_(lines) {}

  Detections detect(const Frame& frame, const EdgeLines& edges) const;
  /// The same from lines that are refined already.
  Detections detect(const Frame& frame, const RefinedLines& lines) const;

 private:
  FloorEdgeOptions options_;
  GeometryOptions geometry_;
  LineRefinementOptions lines_;
};

}  // namespace colonnade
