// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "alignment_checks.hpp"

#include <algorithm>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

constexpr int kMuchTexture = 1500;  ///< before bare walls there are a few hundred points
constexpr double kMinAgreement = 0.15;
constexpr double kSurprise = 22.46;  ///< chi squared, 6 degrees of freedom, 0.1 %

double angleOf(const Eigen::Isometry3d& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

}  // namespace

bool seesTheSame(const Alignment& alignment, const MotionOptions& options) {
  return alignment.photometric_count >= kPointsToRelyOn &&
         alignment.photometric_share >= options.min_share &&
         alignment.gradient_agreement >= kMinAgreement;
}

bool isSound(const Alignment& alignment, const MotionOptions& options) {
  return alignment.converged &&
         (seesTheSame(alignment, options) || (alignment.photometric_count < kPointsToRelyOn &&
                                              alignment.surface_count >= kPointsToRelyOn &&
                                              alignment.surface_share >= options.min_share));
}

bool isFullOfTexture(const Alignment& alignment) {
  return alignment.photometric_count >= kMuchTexture;
}

bool isPlausible(const Eigen::Isometry3d& T_previous_camera, double time_s,
                 const MotionOptions& options) {
  return T_previous_camera.translation().norm() < options.max_speed_m_s * time_s + 0.05 &&
         angleOf(T_previous_camera) < options.max_turn_rate * time_s + radians(2.0);
}

bool isSurprising(const Eigen::Isometry3d& T_previous_camera, const MotionPrior& prior) {
  const Vector6 e = logSe3(prior.T_reference_current.inverse() * T_previous_camera);
  return e.dot(prior.information * e) > kSurprise;
}

bool isWornOut(const Alignment& alignment, const MotionOptions& options) {
  const auto& T = alignment.T_reference_current;
  const double share = alignment.photometric_count == 0
                           ? alignment.surface_share
                           : std::min(alignment.photometric_share, alignment.surface_share);
  return T.translation().norm() > options.keyframe_distance_m ||
         angleOf(T) > options.keyframe_angle || share < options.keyframe_share;
}

MotionSource sourceOf(const Alignment& alignment) {
  if (alignment.photometric_count < kPointsToRelyOn) return MotionSource::kIcp;
  if (alignment.surface_count < kPointsToRelyOn) return MotionSource::kPhotometric;
  return MotionSource::kPhotometricIcp;
}

}  // namespace colonnade
