// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "colonnade/base/measurement.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/filter/sensor_errors.hpp"

namespace colonnade {

/// A whole drive past point landmarks.
struct Drive {
  /// How the robot moved from the pose before to this one.
  struct Motion {
    Pose2 T_previous_robot;
    Eigen::Matrix3d covariance;  ///< (x, y, phi) in the former robot's axes
  };
  struct Sighting {
    std::size_t pose = 0;
    std::size_t point = 0;
    Measurement measurement;
    /// Where to start from; set by smooth(). False: too far off to be of this point, or no
    /// measurement.
    bool used = true;
  };
  /// What is known beforehand: of the first pose, and of the first points together.
  struct Prior {
    Pose2 T_world_start;
    Eigen::Matrix3d information_start;  ///< inverse covariance of (x, y, phi)
    std::vector<Eigen::Vector2d> points_world;
    Eigen::MatrixXd information_points;  ///< two rows for each of them
  };
  /// What the sensor is always off by, found with everything else; beforehand none, with
  /// these standard deviations.
  struct Sensor {
    SensorErrors errors;
    SensorErrors sigmas;
  };
  /// How far a point is from where the camera was at a pose, as known beforehand: without it two
  /// bearings that hardly differ are met best by a point right before the camera.
  struct Depth {
    std::size_t pose = 0;
    std::size_t point = 0;
    Eigen::Vector2d p_robot_camera;
    double inverse_m = 0.0, sigma = 0.0;  ///< 1/m
  };
  std::vector<Pose2> T_world_robot;  ///< one for each frame
  std::vector<Motion> motions;       ///< as many as poses; the first has no say
  std::vector<Eigen::Vector2d> points_world;
  std::vector<Sighting> sightings;
  std::optional<Sensor> sensor = {};  ///< none: the sensor is right
  std::optional<Prior> prior = {};    ///< none: the first pose is given, the points are anywhere
  std::vector<Depth> depths = {};
  /// For each point, or empty: whether it may turn out to be one of the others.
  std::vector<bool> nameless = {};
  struct Pair {
    std::size_t a = 0, b = 0;
  };
  std::vector<Pair> one = {};  ///< points of the prior that are one thing
};

struct Smoothing {
  bool converged = false;  ///< and no sighting came in or went out any more
  int steps = 0;
  std::size_t unused = 0;  ///< sightings
  /// Sum of squared Mahalanobis distances; of sightings their Huber loss, of an unused one that of
  /// a sighting just at the gate.
  double cost = 0.0;
  struct Merger {
    std::size_t point = 0;  ///< has no sightings any more
    /// Where it was; that one may have been merged later. Both points of the prior: Drive::one.
    std::size_t into = 0;
  };
  std::vector<Merger> merged;
  /// Of all points together, two rows for each, square metres, given the first pose or the prior;
  /// empty for more than 500 points.
  Eigen::MatrixXd covariance;
};

/// The likeliest poses and points of a drive given all of its motions and sightings, found from
/// those it holds: nonlinear least squares (Dellaert and Kaess, Square Root SAM, International
/// Journal of Robotics Research 25(12), 2006) with Levenberg's damping. Unlike a filter's estimate
/// every derivative is taken at the result and later sightings correct earlier poses. The first
/// pose stays, unless a prior says how well it is known. Sightings off by more than what one in a
/// hundred is off by pull with Huber's loss; those outside the gate of `gate_probability` at the
/// end are marked unused and the rest is solved again. Stretches bent to suit wrong sightings,
/// between two motions outside the gate, are tried without them; of many or long ones only the
/// first. Points founded twice become one where Drive::nameless allows it. Throws nothing; a drive
/// without a sighting is left as it is.
Smoothing smooth(Drive& drive, double gate_probability);

/// What a drive costs once it is smoothed.
double smoothedCost(Drive drive, double gate_probability);

/// What the sensor of a smoothed drive is off by, and how sure that is given everything: as found
/// where the drive has one, otherwise as it would be found with these standard deviations
/// beforehand, to first order. Nothing where the equations are singular.
struct SensorFit {
  SensorEstimate estimate;
  double gain = 0.0;  ///< how much less the drive would cost
};
std::optional<SensorFit> sensorFit(const Drive& drive, const SensorErrors& sigmas);

}  // namespace colonnade
