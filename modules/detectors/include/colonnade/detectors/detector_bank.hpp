// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/detectors/depth_slope_detector.hpp"
#include "colonnade/detectors/floor_edge_detector.hpp"
#include "colonnade/detectors/pillar_detector.hpp"
#include "colonnade/detectors/wall_direction_detector.hpp"

namespace colonnade {

/// All sections of the detectors. `each` hands every one of them to `take`, to read or write them.
struct DetectorOptions {
  GeometryOptions geometry;
  LineRefinementOptions lines;
  PillarOptions pillars;
  FloorEdgeOptions floor_edges;
  DepthProfileOptions depth_profile;
  DepthSlopeOptions depth_slopes;
  WallDirectionOptions wall_directions;

  template <class Take>
  void each(Take&& take) {
    take(geometry);
    take(lines);
    take(pillars);
    take(floor_edges);
    take(depth_profile);
    take(depth_slopes);
    take(wall_directions);
  }
};

/// All detectors on one frame, with the lines refined and the depth profile cut only once.
class DetectorBank {
 public:
  explicit DetectorBank(const DetectorOptions& options = {});

  /// Pillars, then floor edges, then corners; partners are indices into the whole. A frame without
  /// gray image gives corners only, one without depth no corners and no ranges, one without a
  /// calibrated camera nothing.
  Detections detect(const Frame& frame, const EdgeLines& edges);
  /// Walls of the frame last given to detect(), longest first.
  const std::vector<WallDirection>& wallDirections() const { return wall_directions_; }

 private:
  DetectorOptions options_;
  PillarDetector pillars_;
  FloorEdgeDetector floor_edges_;
  DepthSlopeDetector depth_slopes_;
  WallDirectionDetector walls_;
  std::vector<WallDirection> wall_directions_;
};

}  // namespace colonnade
