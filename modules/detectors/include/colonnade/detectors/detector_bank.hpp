// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "colonnade/detectors/depth_slope_detector.hpp"
#include "colonnade/detectors/door_leaves.hpp"
#include "colonnade/detectors/floor_edge_detector.hpp"
#include "colonnade/detectors/frame_check.hpp"
#include "colonnade/detectors/pillar_detector.hpp"
#include "colonnade/detectors/pillar_memory.hpp"
#include "colonnade/detectors/segmentation.hpp"
#include "colonnade/detectors/short_segment_detector.hpp"
#include "colonnade/detectors/wall_direction_detector.hpp"

namespace colonnade {

/// All sections of the detectors. `each` hands every one of them to `take`, to read or write them.
struct DetectorOptions {
  GeometryOptions geometry;
  LineRefinementOptions lines;
  PillarOptions pillars;
  PillarMemoryOptions pillar_memory;
  DoorLeafOptions door_leaves;
  ShadeOptions shade;
  FloorEdgeOptions floor_edges;
  DepthProfileOptions depth_profile;
  DepthSlopeOptions depth_slopes;
  WallDirectionOptions wall_directions;
  ShortSegmentOptions short_segments;
  SegmentationOptions segmentation;

  template <class Take>
  void each(Take&& take) {
    take(geometry);
    take(lines);
    take(pillars);
    take(pillar_memory);
    take(door_leaves);
    take(shade);
    take(floor_edges);
    take(depth_profile);
    take(depth_slopes);
    take(wall_directions);
    take(short_segments);
    take(segmentation);
  }
};

/// All detectors on one frame, with the lines refined and the depth profile cut only once.
class DetectorBank {
 public:
  explicit DetectorBank(const DetectorOptions& options = {});

  /// Pillars, floor edges, corners, legs; partners are indices into the whole. A frame without
  /// gray image gives corners only, one without depth no corners and no ranges, one without a
  /// calibrated camera nothing.
  /// T_previous_robot: how the robot moved since the frame given before. With it, what is seen on
  /// moving things is refused; without it (the first frame, motion not known) it cannot be told.
  Detections detect(const Frame& frame, const EdgeLines& edges,
                    const std::optional<Pose2>& T_previous_robot = std::nullopt);
  /// Walls of the frame last given to detect(), longest first.
  const std::vector<WallDirection>& wallDirections() const { return wall_directions_; }
  /// The depth slice of that frame; empty without depth.
  const DepthProfile& depthProfile() const { return profile_; }
  /// What moves and what mirrors in that frame.
  const Segmentation& segmentation() const { return segmentation_; }
  /// Why that frame shows nothing, if so; to be counted.
  const std::vector<std::string>& lacking() const { return check_.lacking; }

 private:
  DetectorOptions options_;
  PillarDetector pillars_;
  FloorEdgeDetector floor_edges_;
  DepthSlopeDetector depth_slopes_;
  WallDirectionDetector walls_;
  ShortSegmentDetector short_segments_;
  Segmenter segmenter_;
  PillarMemory memory_;
  DoorLeaves leaves_;
  std::vector<WallDirection> wall_directions_;
  DepthProfile profile_;
  Segmentation segmentation_;
  FrameCheck check_;
};

}  // namespace colonnade
