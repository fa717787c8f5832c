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

}  // namespace colonnade
