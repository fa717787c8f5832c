// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include "colonnade/maps/levelled_scan.hpp"

namespace colonnade {

/// The scan as MRPT's laser programs take it: its sensor pose is planar and on the floor, because
/// planar maps silently refuse scans tilted by more than 0.05 degrees. Beams without an obstacle
/// are flagged invalid.
mrpt::obs::CObservation2DRangeScan::Ptr toObservation(const LevelledScan& scan, double stamp_s,
                                                      double max_range_m);

}  // namespace colonnade
