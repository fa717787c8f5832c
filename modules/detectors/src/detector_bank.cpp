// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/detector_bank.hpp"

#include <iterator>

namespace colonnade {
namespace {

void append(Detections& all, Detections&& some) {
  const std::size_t offset = all.size();
  for (auto& detection : some) {
    if (detection.partner) *detection.partner += offset;
  }
  all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
}

}  // namespace

DetectorBank::DetectorBank(const DetectorOptions& options)
    : options_(options),
      pillars_(options.pillars, options.geometry, options.lines, options.shade),
      floor_edges_(options.floor_edges, options.geometry, options.lines),
      depth_slopes_(options.depth_slopes, options.depth_profile, options.geometry),
      walls_(options.wall_directions, options.depth_profile),
      short_segments_(options.short_segments, options.geometry),
      segmenter_(options.segmentation),
      memory_(options.pillar_memory),
      leaves_(options.door_leaves) {}

Detections DetectorBank::detect(const Frame& frame, const EdgeLines& edges,
                                const std::optional<Pose2>& T_previous_robot) {
  Detections all;
  wall_directions_.clear();
  profile_ = {};
  check_ = checkFrame(frame, edges);
  segmentation_ = segmenter_.segment(frame, T_previous_robot);
  if (!frame.camera.isCalibrated()) {
    // The robot has moved on all the same.
    memory_.judge(all, segmentation_, T_previous_robot);
    leaves_.judge(all, profile_, segmentation_, T_previous_robot);
    return all;
  }
  if (check_.image_usable) {
    const RefinedLines lines = refineLines(frame.gray, edges, options_.lines);
    if (lines.empty()) check_.lacking.emplace_back("the image shows no straight edge");
    if (options_.pillars.enabled) append(all, pillars_.detect(frame, lines));
    if (options_.floor_edges.enabled) append(all, floor_edges_.detect(frame, lines));
  }
  if (check_.depth_usable) {
    profile_ = makeDepthProfile(frame, options_.depth_profile);
    if (options_.depth_slopes.enabled) append(all, depth_slopes_.detect(frame, profile_));
    wall_directions_ = walls_.detect(profile_);
  }
  if (options_.short_segments.enabled && check_.image_usable && check_.depth_usable)
    append(all, short_segments_.detect(frame, edges));
  refuseSegmented(frame, segmentation_, options_.segmentation, all);
  memory_.judge(all, segmentation_, T_previous_robot);
  leaves_.judge(all, profile_, segmentation_, T_previous_robot);
  return all;
}

}  // namespace colonnade
