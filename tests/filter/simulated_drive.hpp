// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/smoother.hpp"

namespace colonnade::testing {

inline constexpr double kRangeSigma_m = 0.05;
inline constexpr double kBearingSigma = radians(1.0);

struct SimulatedDrive {
  Drive truth;  ///< its motions and sightings are noisy
  Drive start;  ///< as dead reckoning and each point's first sighting have it
};

/// Two rounds among posts, on a circle; turns on the spot now and then.
inline SimulatedDrive simulatedDrive(unsigned seed, bool ranged = true, double noise = 1.0) {
  std::mt19937 random(seed);
  const auto gauss = [&](double sigma) {
    return noise * std::normal_distribution<double>(0.0, sigma)(random);
  };
  SimulatedDrive drive;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * kPi * i / 12.0;
    const double radius = i % 2 == 0 ? 5.0 : 2.0;
    drive.truth.points_world.emplace_back(radius * std::cos(angle), 3.0 + radius * std::sin(angle));
  }
  std::vector<bool> seen(drive.truth.points_world.size(), false);
  drive.start.points_world.resize(seen.size());
  Pose2 truth, reckoned;
  for (std::size_t k = 0; k < 240; ++k) {
    Drive::Motion motion{{}, Eigen::Matrix3d::Zero()};
    if (k > 0) {
      const Pose2 way = k % 40 == 0 ? Pose2{0.0, 0.0, 0.3} : Pose2{0.15, 0.0, 0.0425};
      const Eigen::Vector3d sigma(0.015, 0.008, 0.012);
      truth = truth * way;
      motion.T_previous_robot = {way.x + gauss(sigma(0)), way.y + gauss(sigma(1)),
                                 way.phi + gauss(sigma(2))};
      motion.covariance = sigma.cwiseAbs2().asDiagonal();
      reckoned = reckoned * motion.T_previous_robot;
    }
    drive.truth.motions.push_back(motion);
    drive.truth.T_world_robot.push_back(truth);
    drive.start.T_world_robot.push_back(reckoned);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector2d p = transform(truth.inverse(), drive.truth.points_world[i]);
      const double bearing = std::atan2(p.y(), p.x());
      if (p.norm() > 5.0 || std::abs(bearing) > 1.0) continue;
      Measurement m;
      m.z.resize(ranged ? 2 : 1);
      m.R.setZero(m.z.size(), m.z.size());
      m.z(0) = bearing + gauss(kBearingSigma);
      m.R(0, 0) = kBearingSigma * kBearingSigma;
      if (ranged) {
        m.z(1) = p.norm() + gauss(kRangeSigma_m);
        m.R(1, 1) = kRangeSigma_m * kRangeSigma_m;
      }
      drive.truth.sightings.push_back({k, i, m});
      if (seen[i]) continue;
      seen[i] = true;
      const double range = ranged ? m.z(1) : 3.0;
      drive.start.points_world[i] =
          transform(reckoned, range * Eigen::Vector2d(std::cos(m.z(0)), std::sin(m.z(0))));
    }
  }
  drive.start.motions = drive.truth.motions;
  drive.start.sightings = drive.truth.sightings;
  return drive;
}

inline double poseError(const Drive& drive, const Drive& truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.T_world_robot.size(); ++k)
    sum +=
        (drive.T_world_robot[k].translation() - truth.T_world_robot[k].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.T_world_robot.size()));
}

}  // namespace colonnade::testing
