// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/baselines/baseline_options.hpp"

namespace colonnade {

struct TrackedFeature {
  std::uint64_t id = 0;
  Eigen::Vector2d p_px = Eigen::Vector2d::Zero();
};

/// mrpt::vision::CFeatureTracker_KL as kinect-3d-slam uses it: corners are followed from image to
/// image, dropped when lost or near the border, and new ones added where there is room.
class FeatureTracker {
 public:
  explicit FeatureTracker(const KinectSlamOptions& options);
  ~FeatureTracker();
  /// gray: CV_8UC1, of one size.
  std::vector<TrackedFeature> track(const cv::Mat& gray);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
