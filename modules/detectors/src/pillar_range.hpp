// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/pillar_detector.hpp"
#include "depth_view.hpp"

namespace colonnade {

/// What depth says about a steep line in the image.
struct PillarRange {
  enum class Verdict {
    kUnknown,  ///< too little depth beside it, or not clear which side it belongs to
    kMeasured,
    kNotUpright,  ///< the distance changes along it
    kOnFloor      ///< it lies on the floor: a joint, a shadow or a reflection
  };
  Verdict verdict = Verdict::kUnknown;
  double range_m = 0.0;  ///< horizontal, from the camera
  double sigma_m = 0.0;
  double slope_m_per_px = 0.0;  ///< of the nearer surface's range, across the line
  bool smooth = false;          ///< measured, and the surface goes on on the other side
  bool one_sided = false;       ///< range_m is known, but depth fails on the other side
};

PillarRange measurePillarRange(const DepthView& depth, const RefinedLine& line,
                               const PillarOptions& options, const GeometryOptions& geometry);

}  // namespace colonnade
