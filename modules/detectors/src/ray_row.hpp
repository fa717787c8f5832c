// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/levelled_camera.hpp"

namespace colonnade {

/// The levelled rays of a row of pixels, for a depth of 1 m: along the row all parts are linear in
/// the column.
struct RayRow {
  struct Part {
    double first = 0.0, step = 0.0;
    double at(double u_px) const { return first + u_px * step; }
  };
  Part up, ahead, right;

  /// forward: horizontal, unit, in the robot's axes.
  RayRow(const LevelledCamera& camera, double v_px,
         const Eigen::Vector2d& forward = Eigen::Vector2d::UnitX()) {
    const Eigen::Vector3d first = camera.ray(0.0, v_px);
    const Eigen::Vector3d step = camera.ray(1.0, v_px) - first;
    const Eigen::Vector2d to_right(forward.y(), -forward.x());
    up = {first.z(), step.z()};
    ahead = {forward.dot(first.head<2>()), forward.dot(step.head<2>())};
    right = {to_right.dot(first.head<2>()), to_right.dot(step.head<2>())};
  }
};

}  // namespace colonnade
