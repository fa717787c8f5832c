// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "calibration_fits.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Follows one pillar of known width through a log (thesis 2015, section 2.8).
class KnownPillar {
 public:
  /// width_m: 0 = not known; the widest pair of edges in view is then taken.
  explicit KnownPillar(double width_m) : width_m_(width_m) {}

  /// The pillar in this frame, metres; distance and lateral only where depth measured both edges.
  /// Nothing where it is not seen. Starts with the pair whose width in depth is nearest to the
  /// known one (within a quarter), else with the widest in the image; then takes the pair nearest
  /// to the former place, and starts anew after a second without.
  std::optional<PillarPlace> find(const Frame& frame, const Detections& detections);

 private:
  double width_m_;
  struct Place {
    double left_px, right_px, stamp_s;
  };
  std::optional<Place> last_;
};

}  // namespace colonnade
