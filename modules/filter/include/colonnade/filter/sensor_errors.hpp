// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "colonnade/base/measurement.hpp"
#include "colonnade/filter/measurement_models.hpp"

namespace colonnade {

/// What a sensor of ranges and bearings is always off by. At a bearing b from the sensor's own axis
/// (Measurement::camera_direction) and a range r it reads
///   b + bearing_offset + bearing_scale b   and   r + range_offset_m + (range_scale + range_skew b)
///   r.
/// Skewed are ranges made of depths along an optical axis that does not point where it is taken to
/// point; bearings of a wrong focal length are scaled.
struct SensorErrors {
  double range_offset_m = 0.0;
  double range_scale = 0.0;
  double range_skew = 0.0;  ///< 1/rad
  double bearing_offset = 0.0;
  double bearing_scale = 0.0;

  static constexpr int kSize = sizeOf(BlockKind::kSensor);
  using Vector = Eigen::Matrix<double, kSize, 1>;
  Vector vector() const {
    return Vector(range_offset_m, range_scale, range_skew, bearing_offset, bearing_scale);
  }
  static constexpr std::array kNames = {"range_offset_m", "range_scale", "range_skew",
                                        "bearing_offset", "bearing_scale"};
  static SensorErrors of(const Vector& v) { return {v(0), v(1), v(2), v(3), v(4)}; }
};

/// The errors as estimated, and how sure that is (in the order of SensorErrors::vector()).
struct SensorEstimate {
  SensorErrors errors;
  Eigen::Matrix<double, SensorErrors::kSize, SensorErrors::kSize> covariance =
      decltype(covariance)::Zero();
};

using SensorJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, SensorErrors::kSize, 0, 2, SensorErrors::kSize>;

/// What a perfect sensor would read (`ideal`, in the manner of `like`) becomes what this one reads,
/// Jacobians too. Returns the derivative in the errors.
SensorJacobian readWith(const SensorErrors& errors, const Measurement& like,
                        PredictedMeasurement& ideal);

/// A measurement as a perfect sensor would have made it (inverse of readWith).
struct FreedMeasurement {
  Measurement measurement;  ///< R carried along
  MeasurementCovariance J_z;
  SensorJacobian J_errors;
};
FreedMeasurement freedOf(const SensorErrors& errors, const Measurement& measurement);

}  // namespace colonnade
