// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace colonnade {

/// Standard deviation of one depth pixel of a structured-light camera, metres in, metres out.
/// Nguyen, Izadi, Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
/// Tracking", 3DIMPVT 2012, the axial part of equation 1.
constexpr double kinectDepthSigma(double depth_m) {
  const double beyond = depth_m - 0.4;
  return 0.0012 + 0.0019 * beyond * beyond;
}

/// Standard deviation of what calibration leaves in depth: an offset of the disparity, which all
/// pixels share, shifts depth by its square (Khoshelham and Elberink, Sensors 12(2), 2012, eq. 5).
/// 0.012 / m stands for half a pixel with a focal length of 580 px and a base of 75 mm.
constexpr double depthBiasSigma(double depth_m, double bias_per_m2) {
  return bias_per_m2 * depth_m * depth_m;
}

}  // namespace colonnade
