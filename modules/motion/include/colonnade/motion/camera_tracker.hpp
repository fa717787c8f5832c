// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>

#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"

namespace colonnade {

/// How the camera moved in space from the former frame to this one, both in the optical frame.
struct CameraMotion {
  Eigen::Isometry3d T_previous_camera = Eigen::Isometry3d::Identity();
  /// Of e (metres, then radians, axes of this frame's camera) in T_true = T * exp(e).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  MotionSource source = MotionSource::kNone;
  /// Brightness of a picture full of texture contradicted the wheels and was left out: what only
  /// brightness could tell rests on wheels that may slip.
  bool contradicts_wheels = false;
  std::optional<std::size_t> previous_index;  ///< of the former frame tracked
};

/// Visual odometry on gray image and depth: direct alignment to a key frame, starting where the
/// wheels say (`source = auto`), else at the former velocity; that with wide noise while nothing
/// can be aligned. Works at no more than 400 pixels of width. Deterministic, single-threaded.
class CameraTracker {
 public:
  explicit CameraTracker(const MotionOptions& options);
  ~CameraTracker();
  CameraTracker(CameraTracker&&) noexcept;
  CameraTracker& operator=(CameraTracker&&) noexcept;

  /// Frames in the order of time. Asking again for the same frame costs nothing, so that mounting
  /// and motion can share a tracker.
  const CameraMotion& track(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
