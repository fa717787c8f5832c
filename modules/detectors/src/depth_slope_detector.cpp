// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_slope_detector.hpp"

#include <array>
#include <cmath>

#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "corner_in_band.hpp"
#include "depth_slope_corners.hpp"

namespace colonnade {
namespace {

Detection toDetection(const DepthProfile& profile, const SliceCorner& corner,
                      const LevelledCamera& camera, const DepthProfileOptions& slice,
                      const GeometryOptions& geometry) {
  const Eigen::Vector2d offset = profile.R_robot_slice * corner.p_slice();
  const double range_m = offset.norm();
  const double secant = std::hypot(1.0, corner.s);  // range = secant / q
  Eigen::Matrix2d J;  // of (bearing, range) in (s, q); bearings are counter-clockwise
  J << -1.0 / (secant * secant), 0.0, corner.s / (secant * corner.q),
      -secant / (corner.q * corner.q);
  Detection detection;
  auto& m = detection.measurement;
  m.kind = LandmarkKind::kDepthSlope;
  m.p_robot_camera = profile.p_robot_camera;
  m.z.resize(2);
  m.z << std::atan2(offset.y(), offset.x()), range_m;
  const double bias_m = secant * depthBiasSigma(1.0 / corner.q, geometry.depth_bias_per_m2);
  const double tilt = 0.45 * geometry.tilt_sigma;  // corners are seen above and below the camera
  Eigen::Matrix2d R = J * corner.covariance * J.transpose();
  R(0, 0) += tilt * tilt;
  R(1, 1) += bias_m * bias_m + std::pow(0.1 * geometry.tilt_sigma * range_m, 2);
  m.R = R;
  const Eigen::Vector2d p_robot = profile.p_robot_camera + offset;
  const auto top = camera.project({p_robot.x(), p_robot.y(), slice.max_height_m});
  const auto bottom = camera.project({p_robot.x(), p_robot.y(), slice.min_height_m});
  if (top) detection.a_px = *top;
  if (bottom) detection.b_px = *bottom;
  return detection;
}

}  // namespace

Detections DepthSlopeDetector::detect(const Frame& frame, const EdgeLines& /*edges*/) const {
  return detect(frame, makeDepthProfile(frame, profile_));
}

Detections DepthSlopeDetector::detect(const Frame& frame, const DepthProfile& profile) const {
  Detections detections;
  if (profile.empty()) return detections;
  const LevelledCamera camera(frame);
  const InverseColumns columns = inverseColumns(profile);
  std::array<InverseColumns, DepthProfile::kBands> bands;
  for (std::size_t band = 0; band < bands.size(); ++band)
    bands[band] = inverseColumns(profile, static_cast<int>(band));
  for (const auto& corner : findCorners(profile, columns, options_)) {
    Detection detection = toDetection(profile, corner, camera, profile_, geometry_);
    detection.refusal = corner.refusal;
    int agreeing = 0, denying = 0;
    for (const auto& band : bands)
      if (const auto seen = isSeenIn(band, columns, corner, profile.focal_px))
        ++(*seen ? agreeing : denying);
    const bool concave = !corner.jump && corner.left->b < corner.right->b;
    if (detection.accepted() && (agreeing < options_.min_bands || (denying > 0 && !concave)))
      detection.refusal = "not the same at all heights";
    detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace colonnade
