// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/geometry_options.hpp"
#include "colonnade/detectors/refined_line.hpp"
#include "colonnade/detectors/shade.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

struct PillarOptions {
  static constexpr const char* kSection = "Pillars";
  bool enabled = true;
  double vertical_tolerance = radians(4.0);
  double parallel_tolerance = radians(1.0);  ///< in space, of all upright edges of a frame
  double min_length_px = 50.0;
  double min_length_bearing_only_px = 100.0;
  double separation = radians(0.4);   ///< edges of one sign closer than this are one
  double surface_step_m = 0.08;       ///< larger differences beside the edge are a jump in depth
  double upright_tolerance_m = 0.06;  ///< of the horizontal distance along the edge
  double faint_contrast = 10.0;       ///< gray levels of the faintest edge looked for
  double max_foot_m = 0.15;           ///< tallest skirting board: hides the foot of a corner
  double min_head_m = 1.5;            ///< taller than tables, chairs and bins
  double min_pair_width_m = 0.05;
  double max_pair_width_m = 1.2;
  double max_pair_width_px = 100.0;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "look for pillar edges");
    v.angle("vertical_tolerance_deg", vertical_tolerance, {0.5, 30},
            "from the projected vertical in the image");
    v.angle("parallel_tolerance_deg", parallel_tolerance, {0.1, 30},
            "from the projected vertical by more than the other upright edges of the frame");
    v.number("min_length_px", min_length_px, {10, 2000}, "of an edge with range");
    v.number("min_length_bearing_only_px", min_length_bearing_only_px, {10, 2000},
             "of an edge whose depth is not known");
    v.angle("separation_deg", separation, {0, 10}, "edges of one sign closer than this are one");
    v.number("surface_step_m", surface_step_m, {0.01, 1}, "step that separates near from far side");
    v.number("upright_tolerance_m", upright_tolerance_m, {0.01, 1},
             "change of distance along an upright edge, beyond noise");
    v.number("faint_contrast", faint_contrast, {0, 255},
             "gray levels of the faintest upright edge; 0: only edges of the image stage");
    v.number("max_foot_m", max_foot_m, {0.02, 10},
             "height of its lower end above which an edge does not stand on the floor");
    v.number("min_head_m", min_head_m, {0, 10},
             "height of its upper end below which an edge is furniture; 0: any");
    v.number("min_pair_width_m", min_pair_width_m, {0.01, 5}, "narrowest pillar");
    v.number("max_pair_width_m", max_pair_width_m, {0.05, 10}, "widest pillar");
    v.number("max_pair_width_px", max_pair_width_px, {5, 4000}, "widest pillar without range");
  }
};

/// Finds edges that are vertical in space (thesis 2015, sections 2.3 to 2.5), whatever the tilt of
/// the camera, and measures bearing and, where depth agrees along the edge, horizontal range.
/// A landmark is an edge of the building that stands on the floor and is taller than furniture:
/// sides of boards, panels, tables and chairs are refused where depth or the horizon tell. The
/// outline of a round pillar is reported too, although it slides around the pillar as one passes.
class PillarDetector {
 public:
  explicit PillarDetector(const PillarOptions& options = {}, const GeometryOptions& geometry = {},
                          const LineRefinementOptions& lines = {}, const ShadeOptions& shade = {})
      : options_(options), geometry_(geometry), lines_(lines), shade_(shade) {}

  Detections detect(const Frame& frame, const EdgeLines& edges) const;
  /// The same from lines that are refined already.
  Detections detect(const Frame& frame, const RefinedLines& lines) const;

 private:
  PillarOptions options_;
  GeometryOptions geometry_;
  LineRefinementOptions lines_;
  ShadeOptions shade_;
};

}  // namespace colonnade
