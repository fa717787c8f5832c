// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/filter/sensor_errors.hpp"
#include "colonnade/filter/state.hpp"

namespace colonnade {

/// The block of the errors of the sensor that made such a measurement, if they are estimated;
/// floor edges are not read by a range-bearing sensor.
inline const Block* sensorOf(const State& state, const Measurement& measurement) {
  const bool is_read = measurement.kind != LandmarkKind::kFloorEdge;
  return state.sensor && is_read ? state.find(*state.sensor) : nullptr;
}

inline SensorErrors errorsOf(const State& state, const Block* sensor) {
  return sensor ? SensorErrors::of(state.values(*sensor)) : SensorErrors{};
}

/// A measurement freed of its sensor's errors as far as the state knows them.
inline FreedMeasurement freedOf(const State& state, const Measurement& measurement) {
  return freedOf(errorsOf(state, sensorOf(state, measurement)), measurement);
}

/// The same for looks at places alone: R holds what is not known of the errors.
inline Measurement seenWith(const State& state, const Measurement& measurement) {
  const Block* sensor = sensorOf(state, measurement);
  if (!sensor) return measurement;
  FreedMeasurement freed = freedOf(errorsOf(state, sensor), measurement);
  const auto P =
      state.P.block<SensorErrors::kSize, SensorErrors::kSize>(sensor->offset, sensor->offset);
  freed.measurement.R += freed.J_errors * P * freed.J_errors.transpose();
  return freed.measurement;
}

}  // namespace colonnade
