// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/mrclam_import.hpp"

namespace colonnade {

/// Velocities that hold from their stamp on.
struct WheelSpeed {
  double stamp_s = 0.0;
  double speed_m_s = 0.0;
  double turn_rate = 0.0;
};

struct BarcodeReading {
  double stamp_s = 0.0;
  int barcode = 0;
  double range_m = 0.0;
  double bearing = 0.0;
};

/// The files of a UTIAS MRCLAM folder. All throw Error with file and line for a line that has not
/// the stated fields, a number that is not finite, or a stamp that goes back.
std::map<int, int> readSubjectOfBarcode(const std::filesystem::path& folder);
std::vector<MrclamLandmark> readMrclamLandmarks(const std::filesystem::path& folder);
std::vector<WheelSpeed> readWheelSpeeds(const std::filesystem::path& folder, int robot);
std::vector<BarcodeReading> readBarcodeReadings(const std::filesystem::path& folder, int robot);
/// Stamps that repeat are left out.
Trajectory readMrclamTruth(const std::filesystem::path& folder, int robot);

}  // namespace colonnade
