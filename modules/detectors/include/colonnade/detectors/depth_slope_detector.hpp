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
  double min_turn = radians(35.0);  ///< of the surface; slopes of oblique walls are all large
  double window_m = 0.6;            ///< of the surface measured on each side
  int min_columns = 6;              ///< of a surface, for a focal length of 580 px; 4 at least
  double min_face_m = 0.06;         ///< of a surface
  double min_jump_m = 0.07;         ///< larger steps are an occluding edge
  double relief_m = 0.04;           ///< of frames and lips that stand out from a surface's end
  double max_gap_m = 0.15;          ///< between two surfaces that meet
  double reach_px = 2.5;            ///< of the place where surfaces meet from where they end
  double edge_sigma_px = 0.6;       ///< of an outline, for a focal length of 580 px
  int min_bands = 2;                ///< height bands that must show the same corner
  bool concave = true;              ///< also corners that point away from the camera
  bool occlusions = true;           ///< also the near side of jumps in depth

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "look for depth-slope corners");
    v.number("min_range_m", min_range_m, {0.2, 20}, "nearest corner");
    v.number("max_range_m", max_range_m, {0.2, 20}, "farthest corner");
    v.angle("min_turn_deg", min_turn, {5, 120}, "of the surface at a corner");
    v.number("window_m", window_m, {0.05, 5}, "length of surface measured on each side");
    v.integer("min_columns", min_columns, {3, 200}, "of a surface, scaled by f / 580 px");
    v.number("min_face_m", min_face_m, {0.01, 2}, "shortest surface");
    v.number("min_jump_m", min_jump_m, {0.02, 5}, "step in depth that is an occluding edge");
    v.number("relief_m", relief_m, {0, 0.2}, "of frames that stand out from a surface's end");
    v.number("max_gap_m", max_gap_m, {0, 1}, "between two surfaces that meet");
    v.number("reach_px", reach_px, {0.5, 20}, "from the end of a surface to where both meet");
    v.number("edge_sigma_px", edge_sigma_px, {0.1, 10}, "of outlines at f = 580 px, half of it at any");
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
