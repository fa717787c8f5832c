// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rgbd_alignment.hpp"

namespace colonnade {

/// The reference without what moved, such as people, as told by surfaces that are not where they
/// should be now. Nothing where nothing moved, where surfaces of less than `least_share` did, and
/// where so many did, or something so wide, that it must be the camera.
/// `T_reference_current`, `covariance`: where the camera is expected now; covariance of e (metres,
/// then radians, axes of the camera now) in T_true = T * exp(e).
std::optional<Reference> standingPart(const Reference& reference, const RgbdPyramid& current,
                                      const Eigen::Isometry3d& T_reference_current,
                                      const Matrix6& covariance, double least_share);

/// Derivative by e of how far a patch of the reference lies from the plane seen there now: n its
/// normal, q its place, both in the axes of the camera now, q on that plane.
Vector6 planeDistanceByCamera(const Eigen::Vector3d& n, const Eigen::Vector3d& q);

}  // namespace colonnade
