// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/sensor_errors.hpp"

#include "colonnade/base/angle.hpp"

namespace colonnade {

SensorJacobian readWith(const SensorErrors& errors, const Measurement& like,
                        PredictedMeasurement& ideal) {
  const double bearing = wrapAngle(ideal.z(0) - like.camera_direction);
  const double bearing_gain = 1.0 + errors.bearing_scale;
  SensorJacobian J = SensorJacobian::Zero(ideal.z.size(), SensorErrors::kSize);
  if (ideal.z.size() == 2) {
    const double range = ideal.z(1);
    const double gain = 1.0 + errors.range_scale + errors.range_skew * bearing;
    const double by_bearing = range * errors.range_skew;
    J.row(1).head<3>() << 1.0, range, range * bearing;
    ideal.z(1) = gain * range + errors.range_offset_m;
    ideal.H_robot.row(1) = gain * ideal.H_robot.row(1) + by_bearing * ideal.H_robot.row(0);
    ideal.H_block.row(1) = gain * ideal.H_block.row(1) + by_bearing * ideal.H_block.row(0);
  }
  J.row(0).tail<2>() << 1.0, bearing;
  ideal.z(0) = wrapAngle(ideal.z(0) + errors.bearing_offset + errors.bearing_scale * bearing);
  ideal.H_robot.row(0) *= bearing_gain;
  ideal.H_block.row(0) *= bearing_gain;
  return J;
}

FreedMeasurement freedOf(const SensorErrors& errors, const Measurement& measurement) {
  const Eigen::Index size = measurement.z.size();
  FreedMeasurement freed{measurement, MeasurementCovariance::Identity(size, size),
                         SensorJacobian::Zero(size, SensorErrors::kSize)};
  const double bearing_gain = 1.0 + errors.bearing_scale;
  const double bearing =
      wrapAngle(measurement.z(0) - measurement.camera_direction - errors.bearing_offset) /
      bearing_gain;
  freed.measurement.z(0) =
      wrapAngle(measurement.z(0) - errors.bearing_offset - errors.bearing_scale * bearing);
  freed.J_z(0, 0) = 1.0 / bearing_gain;
  freed.J_errors.row(0).tail<2>() << -1.0 / bearing_gain, -bearing / bearing_gain;
  if (size == 2) {
    const double gain = 1.0 + errors.range_scale + errors.range_skew * bearing;
    const double range = (measurement.z(1) - errors.range_offset_m) / gain;
    const double by_bearing = -range * errors.range_skew / gain;
    freed.measurement.z(1) = range;
    freed.J_z(1, 0) = by_bearing * freed.J_z(0, 0);
    freed.J_z(1, 1) = 1.0 / gain;
    freed.J_errors.row(1) = by_bearing * freed.J_errors.row(0);
    freed.J_errors.row(1).head<3>() << -1.0 / gain, -range / gain, -range * bearing / gain;
  }
  freed.measurement.R = freed.J_z * measurement.R * freed.J_z.transpose();
  return freed;
}

}  // namespace colonnade
