// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/base/measurement.hpp"
#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// What a block of the state stands for.
enum class BlockKind {
  kPoint,         ///< (x, y)
  kInverseDepth,  ///< (x, y, alpha, rho): anchor, world bearing, inverse distance; thesis 2015 eq.
                  ///< (12)
  kFloorLine,     ///< (x, y, alpha, d): m(alpha) . (p - anchor) = d, m the unit normal; eq. (14)
  kAxis,          ///< (angle): direction of a building axis, modulo a quarter turn
  kPoseClone,     ///< (x, y, phi): where the robot was when a bearing was first seen
  kSensor         ///< SensorErrors: what a range-bearing sensor is always off by
};
constexpr int sizeOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::kPoint:
      return 2;
    case BlockKind::kInverseDepth:
    case BlockKind::kFloorLine:
      return 4;
    case BlockKind::kSensor:
      return 5;
    case BlockKind::kAxis:
      return 1;
    case BlockKind::kPoseClone:
      return 3;
  }
  return 0;
}

/// What a turn of the world turns: where the point (two parameters) and the direction of a block
/// stand among its parameters; -1: it has none. The other parameters stay.
struct BlockLayout {
  int point;
  int direction;
};
constexpr BlockLayout layoutOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::kPoint:
      return {0, -1};
    case BlockKind::kAxis:
      return {-1, 0};
    case BlockKind::kSensor:
      return {-1, -1};
    default:
      return {0, 2};
  }
}

constexpr BlockLayout kRobotLayout{0, 2};

/// The parameters of one block, at most five, without a heap allocation.
using BlockVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;
using RobotJacobian = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 4, 3>;
using BlockJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

/// A predicted measurement and its Jacobians in the robot pose and in the landmark's block.
struct PredictedMeasurement {
  MeasurementVector z;
  RobotJacobian H_robot;
  BlockJacobian H_block;
};

/// h(x) for a landmark block, in the manner of `like` (how many numbers, which lever arm). A floor
/// line is returned as the camera would see it: of its two descriptions (alpha, d) and
/// (alpha + pi, -d), the one whose direction is nearer to the measured one.
PredictedMeasurement predictMeasurement(const Pose2& T_world_robot, BlockKind kind,
                                        const BlockVector& block, const Measurement& like);

/// R with no standard deviation below 1e-5 (m, rad): how sure a measurement counts at most.
MeasurementCovariance noiseOf(const Measurement& measurement);

/// z - h(x), angles wrapped.
MeasurementVector innovationOf(const Measurement& measurement, const MeasurementVector& predicted);

/// The direction of an axis relative to the robot, modulo a quarter turn: theta - phi.
struct PredictedAxis {
  double direction;
  double H_phi = -1.0;
  double H_axis = 1.0;
};
PredictedAxis predictAxis(const Pose2& T_world_robot, double axis);

/// A new block from a pose and a measurement, with the Jacobians in both (inverse of h).
struct InverseMeasurement {
  BlockVector block;
  RobotJacobian J_robot;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 2> J_z;
};
/// (bearing, range) -> kPoint.
InverseMeasurement pointFromRange(const Pose2& T_world_robot, const Measurement& measurement);
/// (normal direction, distance) -> kFloorLine, anchored at the camera.
InverseMeasurement lineFromFloor(const Pose2& T_world_robot, const Measurement& measurement);

/// Where two bearings of one landmark meet, seen from the poses A (first) and B (now); as a
/// kInverseDepth block anchored at A's camera: alpha from A's bearing alone, rho from the parallax.
struct Triangulation {
  BlockVector block;
  RobotJacobian J_robot_a;
  RobotJacobian J_robot_b;
  Eigen::Matrix<double, 4, 1> J_bearing_a;
  Eigen::Matrix<double, 4, 1> J_bearing_b;
  double baseline_m = 0.0;  ///< across the first ray
  double parallax = 0.0;    ///< angle between the rays, radians, signed
};
Triangulation triangulate(const Pose2& T_world_a, const Measurement& bearing_a,
                          const Pose2& T_world_b, const Measurement& bearing_b);

/// The point of an inverse-depth block and its 2x4 Jacobian; rho must not be 0.
Eigen::Vector2d pointOf(const BlockVector& inverse_depth, Eigen::Matrix<double, 2, 4>* J = nullptr);

}  // namespace colonnade
