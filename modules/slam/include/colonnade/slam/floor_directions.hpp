// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/wall_direction_detector.hpp"

namespace colonnade {

/// What a frame without depth shows of the directions of walls: its floor edges, longest first. A
/// floor edge also holds the heading as a landmark, but only as long as it is in view; the axis
/// carries it around the corner.
std::vector<WallDirection> floorEdgeDirections(const Detections& detections);

}  // namespace colonnade
