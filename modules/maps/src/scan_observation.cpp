// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scan_observation.hpp"

namespace colonnade {

mrpt::obs::CObservation2DRangeScan::Ptr toObservation(const LevelledScan& scan, double stamp_s,
                                                      double max_range_m) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  observation->timestamp = mrpt::Clock::fromDouble(stamp_s);
  observation->sensorLabel = "LEVELLED_SCAN";
  observation->sensorPose = mrpt::poses::CPose3D(scan.T_robot_scan.x, scan.T_robot_scan.y, 0.0,
                                                 scan.T_robot_scan.phi, 0.0, 0.0);
  observation->rightToLeft = true;
  observation->aperture = static_cast<float>(scan.step * static_cast<double>(scan.size() - 1));
  observation->maxRange = static_cast<float>(max_range_m);
  observation->stdError = 0.03F;
  observation->beamAperture = static_cast<float>(scan.step);
  observation->resizeScanAndAssign(scan.size(), 0.0F, false);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    observation->setScanRange(i, scan.ranges_m[i]);
    observation->setScanRangeValidity(i, scan.valid(i));
  }
  return observation;
}

}  // namespace colonnade
