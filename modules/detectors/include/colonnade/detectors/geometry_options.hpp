// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

/// What all detectors assume about the camera: how well its mounting is known and where its depth
/// can be used.
struct GeometryOptions {
  static constexpr const char* kSection = "Geometry";
  double line_sigma_px = 1.0;        ///< error of a line that no number of pixels averages out
  double tilt_sigma = radians(0.5);  ///< of the camera's roll and pitch
  double height_sigma_m = 0.02;      ///< of the camera above the floor
  double depth_bias_per_m2 = 0.012;  ///< systematic depth error, times the squared depth
  double min_depth_m = 0.5;
  double max_depth_m = 5.0;

  void visit(OptionVisitor& v) {
    v.number("line_sigma_px", line_sigma_px, {0, 10}, "error of a line however long it is");
    v.angle("tilt_sigma_deg", tilt_sigma, {0, 10}, "of the camera's roll and pitch");
    v.number("height_sigma_m", height_sigma_m, {0, 1}, "of the camera above the floor");
    v.number("depth_bias_per_m2", depth_bias_per_m2, {0, 0.1},
             "sigma of the systematic depth error at 1 m; it grows with the square");
    v.number("min_depth_m", min_depth_m, {0, 10}, "nearest range measured");
    v.number("max_depth_m", max_depth_m, {0.5, 50}, "farthest range measured");
  }
};

}  // namespace colonnade
