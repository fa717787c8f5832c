// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_note.hpp"

#include <cmath>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr double kSure = 3.0;  ///< deviations

/// "3.5 % long", or nothing.
void addIfSure(std::vector<std::string>& parts, double error, double variance, double unit,
               int digits, const char* more, const char* less) {
  if (std::abs(error) > kSure * std::sqrt(variance))
    parts.push_back(formatFixed(std::abs(unit * error), digits) + (error > 0.0 ? more : less));
}

}  // namespace

std::string sensorNote(const SensorEstimate& sensor, bool in_loaded_map) {
  const SensorErrors& e = sensor.errors;
  const SensorErrors::Vector variance = sensor.covariance.diagonal();
  std::vector<std::string> ranges, bearings, parts;
  addIfSure(ranges, e.range_offset_m, variance(0), 1.0, 3, " m long", " m short");
  addIfSure(ranges, e.range_scale, variance(1), 100.0, 1, " % long", " % short");
  addIfSure(ranges, e.range_skew, variance(2), 100.0, 1, " % longer for each radian to the left",
            " % shorter for each radian to the left");
  addIfSure(bearings, e.bearing_offset, variance(3), degrees(1.0), 1, " degrees to the left",
            " degrees to the right");
  addIfSure(bearings, e.bearing_scale, variance(4), 100.0, 1, " % wide", " % narrow");
  if (!ranges.empty()) parts.push_back("ranges " + joined(ranges, ", "));
  if (!bearings.empty()) parts.push_back("bearings " + joined(bearings, ", "));
  if (parts.empty()) return {};
  return std::string(in_loaded_map ? "compared with the map the sensor" : "the sensor") +
         " seems to read " + joined(parts, "; ") + "; if it is not the wheels" +
         (in_loaded_map ? " or the map" : "") + ", RangeBearing.estimate_sensor=true corrects that";
}

}  // namespace colonnade
