// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// The instants at which the frames of a log are taken, seconds since the start, ascending: one
/// every 1 / rate_hz with the jitter of the camera, without the dropped ones. The first is 0.
std::vector<double> captureTimes(const CameraOptions& camera, double duration_s,
                                 std::uint64_t seed);

}  // namespace colonnade
