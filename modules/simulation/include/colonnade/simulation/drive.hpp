// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

/// The robot's pose at the time of every frame: T_world_robot every 1 / rate_hz seconds, the first
/// at the start. Legs are straight, corners between two legs are arcs, speed changes by at most
/// 0.5 m/s^2 and turns by at most the step's rate. Throws Error (kUsage) when an arc does not fit
/// between its neighbours.
std::vector<Pose2> driveRoute(const Route& route, double rate_hz);

struct RoutePose {
  Pose2 pose;            ///< T_world_robot
  std::size_t step = 0;  ///< of the route, that brought the robot there
};

/// The same, each pose with the step of the route that it belongs to.
std::vector<RoutePose> driveSteps(const Route& route, double rate_hz);

/// How long the route takes, in seconds.
double driveDuration(const Route& route);

/// T_world_robot at each of these times, seconds since the start in ascending order; the robot
/// stays where its route ends.
std::vector<Pose2> posesAt(const Route& route, const std::vector<double>& times_s);

}  // namespace colonnade
