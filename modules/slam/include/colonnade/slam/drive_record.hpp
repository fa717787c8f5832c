// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "colonnade/filter/smoother.hpp"
#include "colonnade/slam/range_bearing_estimator.hpp"

namespace colonnade {

/// Everything a range-bearing session was told, frame by frame, so that the drive can be smoothed.
struct DriveRecord {
  struct Reading {
    std::size_t frame = 0;
    int identity = -1;                       ///< in the log, believed or not
    std::optional<Measurement> measurement;  ///< nothing: of no use
  };
  std::vector<double> stamps_s;
  std::vector<Drive::Motion> motions;
  std::vector<Reading> readings;
  std::vector<RangeBearingScan> scans;  ///< as they came, for another estimator

  void add(double stamp_s, const RangeBearingScan& scan, const RangeBearingReport& report) {
    for (std::size_t i = 0; i < scan.readings.size(); ++i)
      readings.push_back({stamps_s.size(), scan.readings[i].id, report.measurements[i]});
    scans.push_back(scan);
    stamps_s.push_back(stamp_s);
    motions.push_back({report.T_previous_robot, report.motion_covariance});
  }
};

}  // namespace colonnade
