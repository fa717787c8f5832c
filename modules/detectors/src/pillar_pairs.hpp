// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/pillar_detector.hpp"

namespace colonnade {

/// Joins accepted edges that can be the two sides of one pillar: opposite gradients (thesis 2015,
/// sections 2.3 to 2.5), a common stretch of the image, a plausible width; narrowest pairs first,
/// each edge at most once. Sets `partner` and `width_m`.
void pairPillars(Detections& detections, const PillarOptions& options);

}  // namespace colonnade
