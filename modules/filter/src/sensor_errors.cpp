// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/sensor_errors.hpp"

namespace colonnade {

SensorJacobian readWith(const SensorErrors& errors, PredictedMeasurement& ideal) {
  const double bearing = ideal.z(0);
  const double bearing_gain = 1.0 + errors.bearing_scale;
  SensorJacobian J = SensorJacobian::Zero(ideal.z.size(), 4);
  if (ideal.z.size() == 2) {
    const double range = ideal.z(1);
    const double gain = 1.0 + errors.range_scale + errors.range_skew * bearing;
    const double by_bearing = range * errors.range_skew;
    J.row(1) << 1.0, range, range * bearing, 0.0;
    ideal.z(1) = gain * range + errors.range_offset_m;
    ideal.H_robot.row(1) = gain * ideal.H_robot.row(1) + by_bearing * ideal.H_robot.row(0);
    ideal.H_block.row(1) = gain * ideal.H_block.row(1) + by_bearing * ideal.H_block.row(0);
  }
  J(0, 3) = bearing;
  ideal.z(0) = bearing_gain * bearing;
  ideal.H_robot.row(0) *= bearing_gain;
  ideal.H_block.row(0) *= bearing_gain;
  return J;
}

FreedMeasurement freedOf(const SensorErrors& errors, const Measurement& measurement) {
  const Eigen::Index size = measurement.z.size();
  FreedMeasurement freed{measurement, MeasurementCovariance::Identity(size, size),
                         SensorJacobian::Zero(size, 4)};
  const double bearing_gain = 1.0 + errors.bearing_scale;
  const double bearing = measurement.z(0) / bearing_gain;
  freed.measurement.z(0) = bearing;
  freed.J_z(0, 0) = 1.0 / bearing_gain;
  freed.J_errors(0, 3) = -bearing / bearing_gain;
  if (size == 2) {
    const double gain = 1.0 + errors.range_scale + errors.range_skew * bearing;
    const double range = (measurement.z(1) - errors.range_offset_m) / gain;
    const double by_bearing = -range * errors.range_skew / gain;
    freed.measurement.z(1) = range;
    freed.J_z(1, 0) = by_bearing * freed.J_z(0, 0);
    freed.J_z(1, 1) = 1.0 / gain;
    freed.J_errors.row(1) << -1.0 / gain, -range / gain, -range * bearing / gain,
        by_bearing * freed.J_errors(0, 3);
  }
  freed.measurement.R = freed.J_z * measurement.R * freed.J_z.transpose();
  return freed;
}

}  // namespace colonnade
