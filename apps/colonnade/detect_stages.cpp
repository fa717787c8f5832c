// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detect_stages.hpp"

#include <chrono>

#include "colonnade/accelerator/rtl_backend.hpp"
#include "colonnade/detectors/edge_view_of.hpp"

namespace colonnade {

DetectStages::DetectStages(const SessionOptions& options, const std::string& backend)
    : tracker_(std::make_shared<CameraTracker>(options.motion)),
      mounting_(options.motion, tracker_),
      motion_(options.motion, tracker_),
      backend_(makeImageStage(backend, options.edges)),
      detectors_(options.detectors) {}

DetectStages::Seen DetectStages::see(Frame& frame, const std::function<void(Frame&)>& change) {
  mounting_.refine(frame);
  const MotionIncrement moved = motion_.increment(frame, mounting_.uncertainty());
  if (change) change(frame);
  Seen seen;
  seen.T_previous_robot = moved.T_previous_robot;
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  const auto start = Clock::now();
  seen.edges = backend_->extract(frame.gray, edgeViewOf(frame));
  const auto middle = Clock::now();
  seen.detections = detectors_.detect(
      frame, seen.edges, moved.isMeasured() ? std::optional(moved.T_previous_robot) : std::nullopt);
  seen.edges_ms = Milliseconds(middle - start).count();
  seen.lacking = detectors_.lacking();
  seen.detectors_ms = Milliseconds(Clock::now() - middle).count();
  return seen;
}

}  // namespace colonnade
