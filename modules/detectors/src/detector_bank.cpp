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
      pillars_(options.pillars, options.geometry, options.lines),
      floor_edges_(options.floor_edges, options.geometry, options.lines),
      depth_slopes_(options.depth_slopes, options.depth_profile, options.geometry),
      walls_(options.wall_directions, options.depth_profile) {}

Detections DetectorBank::detect(const Frame& frame, const EdgeLines& edges) {
  Detections all;
  wall_directions_.clear();
  if (!frame.camera.isCalibrated()) return all;
  const RefinedLines lines = refineLines(frame.gray, edges, options_.lines);
  if (options_.pillars.enabled) append(all, pillars_.detect(frame, lines));
  if (options_.floor_edges.enabled) append(all, floor_edges_.detect(frame, lines));
  const DepthProfile profile = makeDepthProfile(frame, options_.depth_profile);
  if (options_.depth_slopes.enabled) append(all, depth_slopes_.detect(frame, profile));
  wall_directions_ = walls_.detect(profile);
  return all;
}

}  // namespace colonnade
