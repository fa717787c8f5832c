// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/edge_view.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kSteepest = radians(45.0);  // of the optical axis against the horizon
constexpr double kHorizonMargin = radians(1.5);

}  // namespace

LineRanges predictLineRanges(const EdgeView& view, int width_px, int height_px,
                             const EdgeOptions& options) {
  double lowest = 0.0;
  double highest = 0.0;
  LineRanges ranges;
  const Eigen::Vector3d down = -view.R_robot_camera.transpose().col(2);  // in the camera's axes
  if (view.isKnown() && down.y() > std::cos(kSteepest)) {
    lowest = kPi;
    highest = -kPi;
    double horizon_px = height_px;
    for (const double u : {0.0, width_px - 1.0}) {
      const double x = (u - view.cx_px) / view.fx_px;
      for (const double v : {0.0, height_px - 1.0}) {
        const double y = (v - view.cy_px) / view.fy_px;
        // Image direction of a vertical through the pixel; its normal is the line's theta.
        const double du = view.fx_px * (down.x() - x * down.z());
        const double dv = view.fy_px * (down.y() - y * down.z());
        if (dv <= 0.0) continue;
        lowest = std::min(lowest, std::atan2(-du, dv));
        highest = std::max(highest, std::atan2(-du, dv));
      }
      // The ray through (x, y) is level where it is square to `down`.
      const double y = -(down.x() * x + down.z()) / down.y();
      horizon_px = std::min(horizon_px, view.cy_px + view.fy_px * y);
    }
    if (lowest > highest) lowest = highest = 0.0;
    const double row = std::floor(horizon_px - view.fy_px * kHorizonMargin);
    ranges.first_floor_row = static_cast<int>(std::clamp(row, 0.0, height_px - 1.0));
  }
  const auto whole = [](double angle) {
    return static_cast<int>(std::lround(std::clamp(degrees(angle), -89.0, 89.0)));
  };
  ranges.vertical_from_deg = whole(lowest - options.vertical_tolerance);
  ranges.vertical_to_deg = whole(highest + options.vertical_tolerance);
  return ranges;
}

}  // namespace colonnade
