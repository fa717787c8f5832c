// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/odometry_noise.hpp"
#include "colonnade/simulation/random.hpp"
#include "colonnade/simulation/world.hpp"
#include "colonnade/slam/observation.hpp"

namespace colonnade::testing {

/// What the detectors are made to do. Defaults: about what the detectors' own tests measure on
/// rendered worlds, with misses, clutter and errors that last about a second.
struct PlanSensor {
  bool depth = true;          ///< false: bearings and floor edges only, as from a plain camera
  double pillar_share = 0.7;  ///< of what is in view, detected
  double corner_share = 0.6;
  double floor_share = 0.6;
  double wall_share = 0.8;
  double clutter = 0.3;  ///< false detections a frame
  double bearing_sigma = radians(0.15);
  double direction_sigma = radians(0.5);
  double distance_sigma_m = 0.015;
  double error_memory_s = 1.0;
  /// Fused with the wheels, as visual odometry of this share of error per motion would be; 0: the
  /// wheels alone.
  double visual_share = 0.0;
  double landmark_bias_m = 0.01;  ///< of a landmark's place, new with every side it is seen from
};

/// A drive through a world without drawing it: detections straight from the floor plan, hidden
/// behind walls where they are, with noise. Seconds in place of minutes.
class PlanDrive {
 public:
  PlanDrive(const World& world, std::uint64_t seed, const PlanSensor& sensor = {});

  std::optional<Observation> next();
  /// T_world_robot of the observation last returned.
  const Pose2& truth() const { return truth_; }
  const Building& building() const { return building_; }
  /// From now on edges near a place are gone.
  void removeEdgesNear(const Eigen::Vector2d& p_world, double radius_m);
  /// From now on edges near a place stand elsewhere, looking the same.
  void moveEdgesNear(const Eigen::Vector2d& p_world, double radius_m, const Eigen::Vector2d& by_m);

 private:
  struct Error {
    Eigen::Vector2d value = Eigen::Vector2d::Zero();
    double stamp_s = 0.0;
  };
  Eigen::Vector2d noise(int key, double stamp_s);
  double firstSurface(const Eigen::Vector2d& from, double direction) const;
  void fuseVisual(const Pose2& moved, MotionIncrement& motion);
  void seeEdges(Observation& seen);
  void seeFloor(Observation& seen);
  void seeClutter(Observation& seen);
  void look(Observation& seen) const;

  World world_;
  PlanSensor sensor_;
  Building building_;
  std::vector<Pose2> poses_;
  OdometryNoise odometry_;
  Random random_;
  std::map<int, Error> errors_;
  std::size_t next_ = 0;
  Pose2 truth_;
  Eigen::Vector2d p_camera_ = Eigen::Vector2d::Zero();
};

}  // namespace colonnade::testing
