// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "colonnade/motion/motion_estimator.hpp"
#include "colonnade/slam/session.hpp"

namespace colonnade {

/// The stages of a session up to the detections, without a filter: for verbs that only look.
class DetectStages {
 public:
  /// Throws Error (kUsage) for an image stage that does not exist.
  DetectStages(const SessionOptions& options, const std::string& backend);

  struct Seen {
    EdgeLines edges;
    Detections detections;
    Pose2 T_previous_robot;            ///< motion since the former frame
    std::vector<std::string> lacking;  ///< why the frame shows nothing, if so
    double edges_ms = 0.0;
    double detectors_ms = 0.0;
  };
  /// Frames in the order of the log; rewrites the mounting of hand-carried cameras. `change`, if
  /// any, alters the frame before the image stage and the detectors see it.
  Seen see(Frame& frame, const std::function<void(Frame&)>& change = {});
  const DetectorBank& detectors() const { return detectors_; }

 private:
  std::shared_ptr<CameraTracker> tracker_;
  MountingEstimator mounting_;
  MotionEstimator motion_;
  std::unique_ptr<EdgeLineBackend> backend_;
  DetectorBank detectors_;
};

}  // namespace colonnade
