// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "rgbd_pyramid.hpp"
#include "se3.hpp"

namespace colonnade {

/// So many points of brightness, or surfaces, are needed to rely on them.
inline constexpr int kPointsToRelyOn = 50;

/// What an alignment uses and how far it trusts it.
struct AlignmentOptions {
  bool use_photometric = true;
  bool use_surfaces = true;
  double photometric_correlation = 20.0;  ///< neighbouring residuals that count as one
  double surface_correlation = 35.0;
  /// Directions are used where they hold this many times the information that the noise of the
  /// surface normals, or of the brightness gradients, alone would feign.
  double weak_direction_ratio = 4.0;
  double min_share = 0.3;     ///< an end that compares less of the reference gives way to others
  double lens_falloff = 0.0;  ///< see FalloffEquation
};

/// A frame prepared to be aligned to.
struct Reference {
  RgbdPyramid pyramid;
  std::vector<std::vector<PhotometricPoint>> photometric;  ///< per pyramid level
  std::vector<SurfacePoint> surfaces;
};
Reference makeReference(RgbdPyramid pyramid);

/// Where the current camera is expected: T_true = T * exp(e), e of this information (inverse
/// covariance; metres, radians, current camera's axes).
struct MotionPrior {
  Eigen::Isometry3d T_reference_current = Eigen::Isometry3d::Identity();
  Matrix6 information = Matrix6::Zero();
};

/// Where the current camera is in the reference, and how sure that is.
struct Alignment {
  Eigen::Isometry3d T_reference_current = Eigen::Isometry3d::Identity();
  /// Of the error e (metres, radians, current camera's axes) in T_true = T * exp(e).
  Matrix6 covariance = Matrix6::Zero();
  double photometric_share = 0.0;  ///< of the reference's points that were compared, 0 to 1
  double surface_share = 0.0;
  double gradient_agreement = 0.0;  ///< of brightness; see NormalEquations
  int photometric_count = 0;
  int surface_count = 0;
  /// What this alignment would add to the lens' falloff, whatever pose and exposure are.
  double falloff_step = 0.0;
  double falloff_information = 0.0;
  bool converged = false;
};

/// Gauss-Newton on brightness (after an affine change), point-to-plane distance and the prior,
/// coarse to fine. Starts at the prior and at each of the `other_guesses`; of where they end the
/// one counts that fits best at the finest level.
Alignment align(const Reference& reference, const RgbdPyramid& current, const MotionPrior& prior,
                const std::vector<Eigen::Isometry3d>& other_guesses,
                const AlignmentOptions& options);

/// The same from one start that is near already, at the finest level alone; nothing where it was
/// not.
std::optional<Alignment> alignNear(const Reference& reference, const RgbdPyramid& current,
                                   const MotionPrior& prior,
                                   const Eigen::Isometry3d& T_reference_current,
                                   const AlignmentOptions& options);

/// Counts and covariance at a pose that something else found.
Alignment evaluateAt(const Reference& reference, const RgbdPyramid& current,
                     const MotionPrior& prior, const Eigen::Isometry3d& T_reference_current,
                     const AlignmentOptions& options);

}  // namespace colonnade
