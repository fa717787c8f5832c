// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/range_bearing_observation.hpp"

#include <mrpt/obs/CObservationBearingRange.h>

#include "camera_views.hpp"

namespace colonnade {

RangeBearingScan rangeBearingOf(const mrpt::obs::CObservationBearingRange& observation) {
  RangeBearingScan scan;
  scan.T_robot_sensor = toIsometry(observation.sensorLocationOnRobot);
  scan.range_sigma_m = static_cast<double>(observation.sensor_std_range);
  scan.yaw_sigma = static_cast<double>(observation.sensor_std_yaw);
  for (const auto& from : observation.sensedData) {
    RangeBearing reading{from.landmarkID,
                         static_cast<double>(from.range),
                         static_cast<double>(from.yaw),
                         static_cast<double>(from.pitch),
                         {}};
    if (observation.validCovariances)
      reading.covariance = from.covariance.asEigen().topLeftCorner<2, 2>();
    scan.readings.push_back(reading);
  }
  return scan;
}

}  // namespace colonnade
