// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/pillar_detector.hpp"

namespace colonnade {

/// Joins accepted edges that can be the two sides of one pillar: opposite gradients (thesis 2015,
/// sections 2.3 to 2.5), a common stretch of the image, a plausible width; narrowest pairs first,
/// each edge at most once. Sets `partner` and `width_m`.
void pairPillars(Detections& detections, const PillarOptions& options,
                 const ShadeOptions& shade = {});

/// Where the shade of pillars is known, refuses edges that are not the border of such a shade, and
/// of several borders on one side of a pillar all but the outermost: "largest virtual width"
/// (thesis 2015, sections 2.3 and 2.4: of the columns 309, 349 and 351 the widths are 42, 40 and 2;
/// 42 is the pillar's). Does nothing where no shade is known: there an inner edge may be a
/// landmark.
void refuseFalseEdges(Detections& detections, const ShadeOptions& shade);

}  // namespace colonnade
