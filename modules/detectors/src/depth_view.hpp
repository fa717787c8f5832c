// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "colonnade/detectors/levelled_camera.hpp"
#include "nearest_pixel.hpp"

namespace colonnade {

/// A point seen in depth, levelled.
struct SeenPoint {
  Eigen::Vector3d p_robot;
  double depth_m = 0.0;
  double range_m = 0.0;  ///< horizontal distance from the camera
  double height() const { return p_robot.z(); }
};

/// Depth pixels as points in the robot's axes. Pixels outside the image, not measured, not finite
/// or beyond what a structured-light camera can know give nothing.
class DepthView {
 public:
  static constexpr double kNearest_m = 0.2, kFarthest_m = 15.0;

  DepthView(const Frame& frame, const LevelledCamera& camera) : camera_(camera) {
    const bool usable = frame.depth_m.type() == CV_32FC1 &&
                        (frame.gray.empty() || frame.depth_m.size() == frame.gray.size());
    if (usable) depth_m_ = frame.depth_m;
  }
  /// The farthest depth of this frame, looked for anew: what is missing beyond may be out of reach.
  double farthest_m() const {
    constexpr int kEvery_px = 8;
    double farthest_m = 0.0;
    for (int v = 0; v < depth_m_.rows; v += kEvery_px)
      for (int u = 0; u < depth_m_.cols; u += kEvery_px)
        farthest_m = std::max(farthest_m, depthAt(u, v));
    return farthest_m;
  }
  bool empty() const { return depth_m_.empty(); }

  int rows() const { return depth_m_.rows; }
  int columns() const { return depth_m_.cols; }
  const float* row(int v) const { return depth_m_.ptr<float>(v); }
  const LevelledCamera& camera() const { return camera_; }

  /// 0 where there is none.
  double depthAt(int u, int v) const {
    if (u < 0 || v < 0 || u >= depth_m_.cols || v >= depth_m_.rows) return 0.0;
    const auto depth_m = static_cast<double>(depth_m_.ptr<float>(v)[u]);
    return isMeasured(depth_m) ? depth_m : 0.0;
  }
  std::optional<SeenPoint> at(int u, int v) const {
    const double depth_m = depthAt(u, v);
    if (depth_m <= 0.0) return std::nullopt;
    const Eigen::Vector3d offset = depth_m * camera_.ray(u, v);
    return SeenPoint{camera_.centre() + offset, depth_m, offset.head<2>().norm()};
  }
  std::optional<SeenPoint> at(const Eigen::Vector2d& p_px) const {
    const auto pixel = nearestPixel(p_px);
    return pixel ? at(pixel->u, pixel->v) : std::nullopt;
  }
  /// Horizontal distance of what is seen there, if anything.
  std::optional<double> rangeAt(int u, int v) const {
    const double depth_m = depthAt(u, v);
    if (depth_m <= 0.0) return std::nullopt;
    return depth_m * camera_.ray(u, v).head<2>().norm();
  }

 private:
  static bool isMeasured(double depth_m) {
    return depth_m > kNearest_m && depth_m < kFarthest_m;  // NaN is not
  }
  const LevelledCamera& camera_;
  cv::Mat depth_m_;
};

}  // namespace colonnade
