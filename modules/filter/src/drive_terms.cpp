// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drive_terms.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

constexpr double kHuberProbability = 0.99;
/// A standing robot states no noise at all; its poses are tied to within this.
constexpr double kStandingSigma = 1e-5;  ///< m and rad
/// What is right at the camera has no direction.
constexpr double kNearest_m = 1e-3;

/// J_sensor: the derivative in the errors of the sensor, if the drive has one.
PredictedMeasurement predicted(const Drive& drive, const Drive::Sighting& sighting,
                               SensorJacobian* J_sensor = nullptr) {
  PredictedMeasurement expected =
      predictMeasurement(drive.T_world_robot[sighting.pose], BlockKind::kPoint,
                         drive.points_world[sighting.point], sighting.measurement);
  if (!drive.sensor) return expected;
  const SensorJacobian J = readWith(drive.sensor->errors, sighting.measurement, expected);
  if (J_sensor) *J_sensor = J;
  return expected;
}

Eigen::Vector3d motionResidual(const Drive& drive, std::size_t pose) {
  const Pose2 moved = drive.T_world_robot[pose - 1].inverse() * drive.T_world_robot[pose];
  Eigen::Vector3d residual = moved.vector() - drive.motions[pose].T_previous_robot.vector();
  residual(2) = wrapAngle(residual(2));
  return residual;
}

Eigen::Matrix3d informationOf(const Drive::Motion& motion) {
  const Eigen::Matrix3d standing = kStandingSigma * kStandingSigma * Eigen::Matrix3d::Identity();
  return (motion.covariance + standing).inverse();
}

/// Distances beyond this one count linearly.
double huberBound(Eigen::Index size) {
  return std::sqrt(chiSquareQuantile(kHuberProbability, static_cast<int>(size)));
}

}  // namespace

MotionTerm motionTerm(const Drive& drive, std::size_t pose) {
  const Pose2 &before = drive.T_world_robot[pose - 1], &after = drive.T_world_robot[pose];
  MotionTerm term;
  term.residual = motionResidual(drive, pose);
  const Eigen::Matrix2d R = before.rotation().transpose();
  const Eigen::Vector2d way = R * (after.translation() - before.translation());
  term.J_after.setIdentity();
  term.J_after.topLeftCorner<2, 2>() = R;
  term.J_before = -term.J_after;
  term.J_before.topRightCorner<2, 1>() << way.y(), -way.x();
  term.information = informationOf(drive.motions[pose]);
  return term;
}

SightingTerm sightingTerm(const Drive& drive, const Drive::Sighting& sighting) {
  SightingTerm term;
  const auto expected = predicted(drive, sighting, &term.J_sensor);
  term.residual = -innovationOf(sighting.measurement, expected.z);
  term.J_pose = expected.H_robot;
  term.J_point = expected.H_block;
  term.information = noiseOf(sighting.measurement).inverse();
  return term;
}

DepthTerm depthTerm(const Drive& drive, const Drive::Depth& depth) {
  const Pose2& T_world_robot = drive.T_world_robot[depth.pose];
  const Eigen::Vector2d arm = T_world_robot.rotation() * depth.p_robot_camera;
  const Eigen::Vector2d ray = drive.points_world[depth.point] - T_world_robot.translation() - arm;
  const double d = std::max(ray.norm(), kNearest_m);
  DepthTerm term;
  term.residual = 1.0 / d - depth.inverse_m;
  term.J_point = -ray.transpose() / (d * d * d);
  term.J_pose << -term.J_point, -term.J_point * Eigen::Vector2d(-arm.y(), arm.x());
  term.information = 1.0 / (depth.sigma * depth.sigma);
  return term;
}

double huberLoss(double distance2, Eigen::Index size) {
  const double bound = huberBound(size);
  return distance2 > bound * bound ? bound * (2.0 * std::sqrt(distance2) - bound) : distance2;
}

double huberWeight(double distance2, Eigen::Index size) {
  const double bound = huberBound(size);
  return distance2 > bound * bound ? bound / std::sqrt(distance2) : 1.0;
}

double motionDistance2(const Drive& drive, std::size_t pose) {
  const Eigen::Vector3d residual = motionResidual(drive, pose);
  return residual.dot(informationOf(drive.motions[pose]) * residual);
}

double distance2(const Drive& drive, const Drive::Sighting& sighting) {
  const Eigen::LLT<MeasurementCovariance> R(noiseOf(sighting.measurement));
  const MeasurementVector nu = innovationOf(sighting.measurement, predicted(drive, sighting).z);
  const double distance2 = R.info() == Eigen::Success ? nu.dot(R.solve(nu)) : HUGE_VAL;
  return std::isfinite(distance2) ? distance2 : std::numeric_limits<double>::infinity();
}

}  // namespace colonnade
