// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// One resolution of a frame.
struct PyramidLevel {
  PinholeCamera camera;
  cv::Mat intensity;  ///< CV_32FC4: brightness 0 to 255, its derivative along u, along v, unused
  cv::Mat depth_m;    ///< CV_32FC1, 0 = not measured
};

/// A frame at falling resolutions, finest first (at most 400 pixels wide).
struct RgbdPyramid {
  std::vector<PyramidLevel> levels;
  cv::Mat gray;  ///< CV_8UC1 at the finest resolution
};

/// Without depth or calibration it has no levels; without image it is black.
RgbdPyramid makePyramid(const Frame& frame, int levels);

/// A pixel of the reference whose brightness is compared: where it is and how it looks.
struct PhotometricPoint {
  Eigen::Vector3f p_reference;  ///< optical frame, metres
  Eigen::Vector2f gradient;     ///< brightness per pixel along u and v
  float brightness;
};

/// A patch of a surface of the reference, smoothed by a plane fit in inverse depth.
struct SurfacePoint {
  Eigen::Vector3f p_reference;
  Eigen::Vector3f normal;  ///< unit, towards the camera
  float inverse_variance;  ///< of the distance along the normal to a pixel of another frame, 1/m^2
  float normal_variance;   ///< rad^2, per axis
};

/// Strongest pixel of each cell, away from depth discontinuities.
std::vector<PhotometricPoint> selectPhotometricPoints(const PyramidLevel& level, int cell_px,
                                                      float min_gradient);
/// A smooth patch for each cell.
std::vector<SurfacePoint> selectSurfacePoints(const PyramidLevel& level, int cell_px);

/// Standard deviation of one structured-light depth value (Nguyen et al. 2012, eq. 3: axial noise).
inline float depthSigma(float depth_m) {
  const float beyond = depth_m - 0.4f;
  return 0.0012f + 0.0019f * beyond * beyond;
}

}  // namespace colonnade
