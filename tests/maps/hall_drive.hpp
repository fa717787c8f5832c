// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/maps/map_recorder.hpp"
#include "synthetic_hall.hpp"

namespace colonnade::testing {

inline constexpr double kFirstStamp_s = 1700000000.0;
inline constexpr double kFramePeriod_s = 0.1;

/// Poses of a robot that weaves down the corridor: 81 frames, 8 m.
inline std::vector<Pose2> drivePoses() {
  std::vector<Pose2> poses;
  for (int i = 0; i <= 80; ++i) {
    const double x = 0.1 * i;
    poses.push_back({x, 0.25 * std::sin(0.8 * x), std::atan(0.2 * std::cos(0.8 * x))});
  }
  return poses;
}

/// Lets the recorder see the drive; the motion it is told is `scale` times the true one.
inline Trajectory recordDrive(MapRecorder& recorder, double scale = 1.0) {
  const auto walls = corridor();
  const auto T_robot_camera = mountCamera(0.1, 0.9, radians(8.0));
  const auto poses = drivePoses();
  Trajectory trajectory;
  const Eigen::Matrix3d motion_covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double stamp_s = kFirstStamp_s + kFramePeriod_s * static_cast<double>(i);
    Pose2 increment = i == 0 ? Pose2{} : poses[i - 1].inverse() * poses[i];
    increment.x *= scale;
    recorder.add(renderFrame(walls, poses[i], T_robot_camera, stamp_s), poses[i],
                 Eigen::Matrix3d::Identity() * 1e-4, increment, motion_covariance);
    trajectory.push_back({stamp_s, poses[i].toIsometry3()});
  }
  return trajectory;
}

}  // namespace colonnade::testing
