// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/depth_profile.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/geometry_options.hpp"
#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {

struct DepthSlopeOptions {
  static constexpr const char* kSection = "DepthSlopes";
  bool enabled = true;
  double min_range_m = 1.22;  ///< thesis 2012: where a Kinect can be trusted
  double max_range_m = 3.81;
  double min_slope_change = 1.0;    ///< of dz/dx between the two sides
  double min_turn = radians(35.0);  ///< of the surface; slopes of oblique walls are all large
  double window_m = 0.25;           ///< of the profile on each side
  int min_columns = 6;              ///< with depth in each window
  double min_jump_m = 0.2;          ///< larger steps are an occluding edge
  double separation_m = 0.15;       ///< between two corners
  int min_bands = 2;                ///< height bands that must show the same corner
  bool concave = true;              ///< also corners that point away from the camera
  bool occlusions = true;           ///< also the near side of jumps in depth

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "look for depth-slope corners");
    v.number("min_range_m", min_range_m, {0.2, 20}, "nearest corner");
    v.number("max_range_m", max_range_m, {0.2, 20}, "farthest corner");
    v.number("min_slope_change", min_slope_change, {0.05, 20}, "of dz/dx between the two sides");
    v.angle("min_turn_deg", min_turn, {5, 120}, "of the surface at a corner");
    v.number("window_m", window_m, {0.05, 2}, "length of surface measured on each side");
    v.integer("min_columns", min_columns, {3, 200}, "columns with depth on each side");
    v.number("min_jump_m", min_jump_m, {0.05, 5}, "step in depth that is an occluding edge");
    v.number("separation_m", separation_m, {0, 2}, "least distance between corners");
    v.integer("min_bands", min_bands, {1, 3}, "of three height bands that must agree");
    v.flag("concave", concave, "also corners that point away from the camera");
    v.flag("occlusions", occlusions, "also the near side of jumps in depth");
  }
};

/// Vertical corners in the levelled depth profile: columns where the slope dz/dx differs between
/// both sides (thesis 2012, "Landmark Detection": each column once, O(n); the next valid column is
/// the neighbour, whatever lies between). Slopes are fitted over a window, since single differences
/// of Kinect depth are noise. A jump in depth counts for its near side, never for its far side.
class DepthSlopeDetector {
 public:
  explicit DepthSlopeDetector(const DepthSlopeOptions& options = {},
                              const DepthProfileOptions& profile = {},
                              const GeometryOptions& geometry = {})
      : options_(options), profile_(profile), geometry_(geometry) {}

  Detections detect(const Frame& frame, const EdgeLines& edges) const;
  /// The same from a profile of the frame that exists already.
  Detections detect(const Frame& frame, const DepthProfile& profile) const;

 private:
  DepthSlopeOptions options_;
  DepthProfileOptions profile_;
  GeometryOptions geometry_;
};

}  // namespace colonnade
