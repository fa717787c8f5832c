// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/measurement_models.hpp"

#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// No sensor is better than this (metres and radians). One that states less would make the
/// innovation covariance singular at the second look, and be refused for good.
constexpr double kSmallestSigma = 1e-5;

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// The vector turned by a quarter counter-clockwise: the derivative of a rotation.
Eigen::Vector2d turned(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

struct CameraPosition {
  Eigen::Vector2d p_world;
  Eigen::Matrix<double, 2, 3> J_robot;
};
CameraPosition cameraOf(const Pose2& T_world_robot, const Measurement& measurement) {
  CameraPosition camera;
  camera.p_world = transform(T_world_robot, measurement.p_robot_camera, &camera.J_robot);
  return camera;
}

/// Bearing (and range) of the point c + v / scale, from v and its Jacobians in robot and block.
PredictedMeasurement predictFromOffset(
    const Pose2& T_world_robot, const Eigen::Vector2d& v,
    const Eigen::Matrix<double, 2, 3>& V_robot,
    const Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 4>& V_block, double scale, int scale_index,
    bool with_range) {
  const double length = v.norm();
  const Eigen::RowVector2d J_bearing = turned(v).transpose() / v.squaredNorm();
  const Eigen::Index rows = with_range ? 2 : 1;
  PredictedMeasurement p;
  p.z.resize(rows);
  p.H_robot.resize(rows, 3);
  p.H_block.resize(rows, V_block.cols());
  p.z(0) = wrapAngle(std::atan2(v.y(), v.x()) - T_world_robot.phi);
  p.H_robot.row(0) = J_bearing * V_robot;
  p.H_robot(0, 2) -= 1.0;
  p.H_block.row(0) = J_bearing * V_block;
  if (with_range) {
    const Eigen::RowVector2d J_range = v.transpose() / (length * scale);
    p.z(1) = length / scale;
    p.H_robot.row(1) = J_range * V_robot;
    p.H_block.row(1) = J_range * V_block;
    if (scale_index >= 0) p.H_block(1, scale_index) -= length / (scale * scale);
  }
  return p;
}

PredictedMeasurement predictPoint(const Pose2& T_world_robot, const BlockVector& block,
                                  const Measurement& like) {
  const auto camera = cameraOf(T_world_robot, like);
  const Eigen::Vector2d v = block.head<2>() - camera.p_world;
  return predictFromOffset(T_world_robot, v, -camera.J_robot, Eigen::Matrix2d::Identity(), 1.0, -1,
                           like.hasRange());
}

/// v = rho (anchor - c) + m(alpha) points at the landmark and is rho times as long as the way
/// there, so that the bearing stays defined for rho = 0 (thesis 2015, eq. 12 and 13).
PredictedMeasurement predictInverseDepth(const Pose2& T_world_robot, const BlockVector& block,
                                         const Measurement& like) {
  const auto camera = cameraOf(T_world_robot, like);
  const Eigen::Vector2d to_anchor = block.head<2>() - camera.p_world;
  const Eigen::Vector2d m = unit(block(2));
  const double rho = block(3);
  Eigen::Matrix<double, 2, 4> V_block;
  V_block << rho * Eigen::Matrix2d::Identity(), turned(m), to_anchor;
  return predictFromOffset(T_world_robot, rho * to_anchor + m, -rho * camera.J_robot, V_block, rho,
                           3, like.hasRange());
}

/// (alpha - phi, d - m(alpha) . (c - anchor)): thesis 2015 eq. (14) with the sign its root loses.
PredictedMeasurement predictFloorLine(const Pose2& T_world_robot, const BlockVector& block,
                                      const Measurement& like) {
  const auto camera = cameraOf(T_world_robot, like);
  const Eigen::Vector2d from_anchor = camera.p_world - block.head<2>();
  const Eigen::Vector2d m = unit(block(2));
  PredictedMeasurement p;
  p.z.resize(2);
  p.z << wrapAngle(block(2) - T_world_robot.phi), block(3) - m.dot(from_anchor);
  p.H_robot.resize(2, 3);
  p.H_robot << 0.0, 0.0, -1.0, -m.transpose() * camera.J_robot;
  p.H_block.resize(2, 4);
  p.H_block << 0.0, 0.0, 1.0, 0.0, m.transpose(), -turned(m).dot(from_anchor), 1.0;
  if (std::abs(wrapAngle(like.z(0) - p.z(0))) > kPi / 2.0) {
    p.z << wrapAngle(p.z(0) + kPi), -p.z(1);
    p.H_robot.row(1) *= -1.0;
    p.H_block.row(1) *= -1.0;
  }
  return p;
}

}  // namespace

PredictedMeasurement predictMeasurement(const Pose2& T_world_robot, BlockKind kind,
                                        const BlockVector& block, const Measurement& like) {
  switch (kind) {
    case BlockKind::kInverseDepth:
      return predictInverseDepth(T_world_robot, block, like);
    case BlockKind::kFloorLine:
      return predictFloorLine(T_world_robot, block, like);
    default:
      return predictPoint(T_world_robot, block, like);
  }
}

MeasurementCovariance noiseOf(const Measurement& measurement) {
  MeasurementCovariance R = measurement.R;
  R.diagonal() = R.diagonal().cwiseMax(kSmallestSigma * kSmallestSigma);
  return R;
}

MeasurementVector innovationOf(const Measurement& measurement, const MeasurementVector& predicted) {
  MeasurementVector nu = measurement.z - predicted;
  nu(0) = wrapAngle(nu(0));
  return nu;
}

PredictedAxis predictAxis(const Pose2& T_world_robot, double axis) {
  return {wrapQuarterTurn(axis - T_world_robot.phi)};
}

InverseMeasurement pointFromRange(const Pose2& T_world_robot, const Measurement& measurement) {
  const auto camera = cameraOf(T_world_robot, measurement);
  const double range = measurement.z(1);
  const Eigen::Vector2d m = unit(T_world_robot.phi + measurement.z(0));
  InverseMeasurement inverse;
  inverse.block = camera.p_world + range * m;
  inverse.J_robot = camera.J_robot;
  inverse.J_robot.col(2) += range * turned(m);
  inverse.J_z.resize(2, 2);
  inverse.J_z << range * turned(m), m;
  return inverse;
}

InverseMeasurement lineFromFloor(const Pose2& T_world_robot, const Measurement& measurement) {
  const auto camera = cameraOf(T_world_robot, measurement);
  InverseMeasurement inverse;
  inverse.block.resize(4);
  inverse.block << camera.p_world, wrapAngle(T_world_robot.phi + measurement.z(0)),
      measurement.z(1);
  inverse.J_robot.setZero(4, 3);
  inverse.J_robot.topRows<2>() = camera.J_robot;
  inverse.J_robot(2, 2) = 1.0;
  inverse.J_z.setZero(4, 2);
  inverse.J_z(2, 0) = 1.0;
  inverse.J_z(3, 1) = 1.0;
  return inverse;
}

Triangulation triangulate(const Pose2& T_world_a, const Measurement& bearing_a,
                          const Pose2& T_world_b, const Measurement& bearing_b) {
  const auto a = cameraOf(T_world_a, bearing_a);
  const auto b = cameraOf(T_world_b, bearing_b);
  const double alpha = T_world_a.phi + bearing_a.z(0);
  const double beta = T_world_b.phi + bearing_b.z(0);
  const Eigen::Vector2d m_b = unit(beta);
  const Eigen::Vector2d n_b = turned(m_b);
  const Eigen::Vector2d baseline = b.p_world - a.p_world;
  // On ray B: n_b . (c_a + m_a / rho - c_b) = 0, so rho = n_b . m_a / n_b . (c_b - c_a): the sine
  // law of thesis 2015, section 1.3, with numerator sin(alpha - beta).
  const double numerator = std::sin(alpha - beta);
  const double denominator = n_b.dot(baseline);
  const double cosine = std::cos(alpha - beta);

  Triangulation t;
  t.block.resize(4);
  t.block << a.p_world, wrapAngle(alpha), numerator / denominator;
  t.baseline_m = std::abs(turned(unit(alpha)).dot(baseline));
  t.parallax = wrapAngle(beta - alpha);

  const double by_numerator = 1.0 / denominator;
  const double by_denominator = -numerator / (denominator * denominator);
  const double by_alpha = cosine * by_numerator;
  // d(n_b)/d(beta) = -m_b.
  const double by_beta = -cosine * by_numerator - m_b.dot(baseline) * by_denominator;
  t.J_robot_a.setZero(4, 3);
  t.J_robot_a.topRows<2>() = a.J_robot;
  t.J_robot_a(2, 2) = 1.0;
  t.J_robot_a.row(3) = -by_denominator * (n_b.transpose() * a.J_robot);
  t.J_robot_a(3, 2) += by_alpha;
  t.J_robot_b.setZero(4, 3);
  t.J_robot_b.row(3) = by_denominator * (n_b.transpose() * b.J_robot);
  t.J_robot_b(3, 2) += by_beta;
  t.J_bearing_a << 0.0, 0.0, 1.0, by_alpha;
  t.J_bearing_b << 0.0, 0.0, 0.0, by_beta;
  return t;
}

Eigen::Vector2d pointOf(const BlockVector& inverse_depth, Eigen::Matrix<double, 2, 4>* J) {
  const Eigen::Vector2d m = unit(inverse_depth(2));
  const double distance = 1.0 / inverse_depth(3);
  if (J) *J << Eigen::Matrix2d::Identity(), distance * turned(m), -distance * distance * m;
  return inverse_depth.head<2>() + distance * m;
}

}  // namespace colonnade
