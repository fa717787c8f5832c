// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrclam_folder.hpp"

namespace colonnade {

/// How the robot drove under the commands of a log, in the order of time; the stamps are those of
/// the camera. Turns start late: see MrclamCalibration.
std::vector<WheelSpeed> drivenSpeeds(const std::vector<WheelSpeed>& commands,
                                     const MrclamCalibration& calibration);

}  // namespace colonnade
