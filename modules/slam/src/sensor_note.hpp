// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/filter/sensor_errors.hpp"

namespace colonnade {

/// What a sensor seems to be off by, for its user: those errors that are sure; empty where none is.
/// In a loaded map that is measured against the sensor that made the map.
std::string sensorNote(const SensorEstimate& sensor, bool in_loaded_map);

}  // namespace colonnade
