// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/edges/edge_options.hpp"

namespace colonnade {

/// How the camera looks at the floor in one frame, for backends that look only where lines of
/// interest can be. Default: not known.
struct EdgeView {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  /// Columns: the optical axes (x right, y down, z forward) in the robot's (z up).
  Eigen::Matrix3d R_robot_camera = Eigen::Matrix3d::Identity();
  bool isKnown() const { return fx_px > 0.0 && fy_px > 0.0; }
};

/// Where the lines of an image can lie.
struct LineRanges {
  int vertical_from_deg = 0;  ///< theta of lines along the projected vertical, whole degrees
  int vertical_to_deg = 0;
  int first_floor_row = 0;  ///< rows above it see no floor
};

/// The angles of verticals anywhere in the image, widened by options.vertical_tolerance, and the
/// horizon less a margin. An unknown view, or one that looks steeply up or down: verticals as in
/// the image, floor everywhere.
LineRanges predictLineRanges(const EdgeView& view, int width_px, int height_px,
                             const EdgeOptions& options);

}  // namespace colonnade
