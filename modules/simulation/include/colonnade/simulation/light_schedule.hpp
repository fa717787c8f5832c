// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace colonnade {

/// How bright the building is while the robot drives: day, dusk, a part where the lamps are weak.
/// Levels are relative to the light painted on the surfaces; between two points of the schedule the
/// light changes linearly, before the first and after the last it stays.
struct LightSchedule {
  struct Point {
    double at = 0.0;                                  ///< metres driven, or seconds since the start
    Eigen::Vector3d light = Eigen::Vector3d::Ones();  ///< of red, green, blue; 1 = as painted
  };

  std::vector<Point> points;  ///< in ascending order; empty: the light is as painted
  bool by_time = false;       ///< else by the distance driven

  Eigen::Vector3d lightAt(double time_s, double driven_m) const;
};

}  // namespace colonnade
