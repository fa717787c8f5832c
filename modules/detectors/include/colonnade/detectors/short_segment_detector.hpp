// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/geometry_options.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

struct ShortSegmentOptions {
  static constexpr const char* kSection = "ShortSegments";
  bool enabled = false;
  double min_length_px = 14.0;
  double attach_px = 1.3;  ///< from a growing segment's line to its next pixel
  int max_gap_px = 2;
  double max_residual_px = 0.6;
  double vertical_tolerance = radians(6.0);
  double min_width_m = 0.015;  ///< of a leg
  double max_width_m = 0.10;
  double min_length_m = 0.15;
  double stands_out_m = 0.12;  ///< nearer than what is beside it
  double max_foot_m = 0.25;    ///< its lower end above the floor
  double max_range_m = 4.0;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "look for short upright segments: legs of tables and chairs");
    v.number("min_length_px", min_length_px, {6, 1000}, "shortest segment in the image");
    v.number("attach_px", attach_px, {0.5, 5}, "from a segment's line to its next pixel");
    v.integer("max_gap_px", max_gap_px, {0, 20}, "rows without a pixel that do not end a segment");
    v.number("max_residual_px", max_residual_px, {0.1, 5}, "root mean square of a segment");
    v.angle("vertical_tolerance_deg", vertical_tolerance, {0.5, 30}, "from the vertical");
    v.number("min_width_m", min_width_m, {0.002, 1}, "thinnest leg");
    v.number("max_width_m", max_width_m, {0.005, 1}, "thickest leg");
    v.number("min_length_m", min_length_m, {0.02, 2}, "shortest leg");
    v.number("stands_out_m", stands_out_m, {0.02, 2}, "a leg is nearer than what is beside it");
    v.number("max_foot_m", max_foot_m, {0.02, 2}, "height of a leg's lower end");
    v.number("max_range_m", max_range_m, {0.5, 20}, "farthest leg");
  }
};

/// Thin upright things that stand free on the floor: legs of tables and chairs (thesis 2015,
/// conclusion). Edge pixels are joined row by row to segments that a running least-squares line
/// leads (an incremental line search: each edge pixel once, no accumulator), then two segments of
/// opposite gradient are a leg if depth says that it stands free. Needs depth.
class ShortSegmentDetector {
 public:
  explicit ShortSegmentDetector(const ShortSegmentOptions& options = {},
                                const GeometryOptions& geometry = {})
      : options_(options), geometry_(geometry) {}

  /// Pillar edges with range, always in pairs.
  Detections detect(const Frame& frame, const EdgeLines& edges) const;

 private:
  ShortSegmentOptions options_;
  GeometryOptions geometry_;
};

}  // namespace colonnade
