// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The table of detections: one row each, accepted or refused.
///   stamp, frame, detection (index in the frame), kind, refusal (empty = accepted),
///   u0, v0, u1, v1 (ends of the line, pixels), angle_deg (bearing, or direction of a floor edge's
///   normal, robot's axes), distance_m (horizontal, from the camera; empty: bearing only),
///   sigma_deg, sigma_m, gradient_sign, partner, width_m, on_surface (1: paint, joint or gap)
std::string detectionCsvHeader();
std::string detectionCsvRows(const Frame& frame, const Detections& detections);

}  // namespace colonnade
