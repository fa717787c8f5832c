// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/measurement.hpp"
#include "colonnade/filter/measurement_models.hpp"

namespace colonnade {

/// What a sensor of ranges and bearings is always off by. It reads a bearing b and a range r as
///   (1 + bearing_scale) b   and   (1 + range_scale + range_skew b) r + range_offset_m.
/// Skewed are ranges made of depths along an optical axis that does not point where it is taken to
/// point, bearings of a wrong focal length are scaled. An offset of bearings is not among the
/// errors: from inside it is a robot whose wheels drive it askew.
struct SensorErrors {
  double range_offset_m = 0.0;
  double range_scale = 0.0;
  double range_skew = 0.0;  ///< 1/rad
  double bearing_scale = 0.0;

  Eigen::Vector4d vector() const {
    return {range_offset_m, range_scale, range_skew, bearing_scale};
  }
  static SensorErrors of(const Eigen::Vector4d& v) { return {v(0), v(1), v(2), v(3)}; }
};

/// The errors as estimated, and how sure that is (in the order of SensorErrors::vector()).
struct SensorEstimate {
  SensorErrors errors;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

using SensorJacobian = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, 2, 4>;

/// What a perfect sensor would read becomes what this one reads, Jacobians too. Returns the
/// derivative in the errors.
SensorJacobian readWith(const SensorErrors& errors, PredictedMeasurement& ideal);

/// A measurement as a perfect sensor would have made it (inverse of readWith).
struct FreedMeasurement {
  Measurement measurement;  ///< R carried along
  MeasurementCovariance J_z;
  SensorJacobian J_errors;
};
FreedMeasurement freedOf(const SensorErrors& errors, const Measurement& measurement);

}  // namespace colonnade
