// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/filter/measurement_models.hpp"
#include "colonnade/filter/smoother.hpp"

namespace colonnade {

// The terms of a drive's least squares: what each is off by where the drive is, its derivatives in
// (x, y, phi) of poses and (x, y) of points, and its information.

struct MotionTerm {
  Eigen::Vector3d residual;
  Eigen::Matrix3d J_before, J_after;
  Eigen::Matrix3d information;
};
/// The motion up to a pose, not the first.
MotionTerm motionTerm(const Drive& drive, std::size_t pose);

struct SightingTerm {
  MeasurementVector residual;
  RobotJacobian J_pose;
  BlockJacobian J_point;
  SensorJacobian J_sensor;  ///< if the drive has a sensor
  MeasurementCovariance information;
};
SightingTerm sightingTerm(const Drive& drive, const Drive::Sighting& sighting);

struct DepthTerm {
  double residual = 0.0;
  Eigen::RowVector3d J_pose;
  Eigen::RowVector2d J_point;
  double information = 0.0;
};
DepthTerm depthTerm(const Drive& drive, const Drive::Depth& depth);

/// What a squared Mahalanobis distance of a sighting with so many numbers adds to the cost.
double huberLoss(double distance2, Eigen::Index size);
/// What the information of a sighting so far off is multiplied by for that loss.
double huberWeight(double distance2, Eigen::Index size);

/// Squared Mahalanobis distances of the motion up to a pose (not the first) and of a sighting;
/// infinite for a sighting that is not finite or whose R is no covariance.
double motionDistance2(const Drive& drive, std::size_t pose);
double distance2(const Drive& drive, const Drive::Sighting& sighting);

/// Keeps a point that was only seen along one ray where it is.
constexpr double kLooseSigma_m = 100.0;
/// Holds an error of the sensor that is known not to be there.
constexpr double kKnownSigma = 1e-6;

}  // namespace colonnade
