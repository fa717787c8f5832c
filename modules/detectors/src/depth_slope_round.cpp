// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_round.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

Eigen::Vector2d pointOf(const InverseColumn& column) {
  return Eigen::Vector2d(column.s, 1.0) / column.q;
}

/// What of a column stays the same from round to round.
struct ArcPoint {
  Eigen::Vector2d p;    ///< from the origin of the fit, m
  Eigen::Vector2d ray;  ///< unit
  double sigma_m;       ///< along the ray
  ArcPoint(const InverseColumn& column, const Eigen::Vector2d& origin)
      : p(pointOf(column) - origin) {
    const Eigen::Vector2d along(column.s, 1.0);
    ray = along.normalized();
    sigma_m = std::sqrt(column.variance) / (column.q * column.q) * along.norm();
  }
  /// Across the circle: noise is along the ray, which a slanting surface shortens.
  double sigmaAcross(const Eigen::Vector2d& normal) const {
    constexpr double kMostSlanted = 0.25;
    return sigma_m * std::max(std::abs(normal.dot(ray)), kMostSlanted);
  }
};

}  // namespace

SliceCircle fitCircle(const InverseColumns& columns, std::size_t first, std::size_t last) {
  SliceCircle circle;
  if (last - first < 5) return circle;
  const Eigen::Vector2d origin = pointOf(columns[(first + last) / 2]);
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  std::vector<ArcPoint> points;
  points.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d& p = points.emplace_back(columns[i], origin).p;
    const Eigen::Vector3d row(p.x(), p.y(), 1.0);
    A += row * row.transpose();
    v += row * p.squaredNorm();
  }
  const Eigen::Vector3d algebraic = A.ldlt().solve(v);
  Eigen::Vector2d centre = 0.5 * algebraic.head<2>();
  double radius_m = std::sqrt(std::max(0.0, algebraic[2] + centre.squaredNorm()));
  constexpr double kLargest_m = 5.0;
  constexpr int kRounds = 6;
  for (int round = 0; round <= kRounds; ++round) {
    if (!(radius_m > 0.01 && radius_m < kLargest_m)) return {};
    A.setZero();
    v.setZero();
    circle.cost = 0.0;
    for (const ArcPoint& point : points) {
      const Eigen::Vector2d away = point.p - centre;
      const double distance_m = std::max(away.norm(), 1e-6);
      const Eigen::Vector2d normal = away / distance_m;
      const double error = distance_m - radius_m;
      const double sigma = point.sigmaAcross(normal);
      const Eigen::Vector3d row(normal.x(), normal.y(), 1.0);
      A += row * row.transpose() / (sigma * sigma);
      v += row * error / (sigma * sigma);
      circle.cost += error * error / (sigma * sigma);
    }
    if (round == kRounds) break;
    const Eigen::Vector3d step = A.ldlt().solve(v);
    if (!step.allFinite()) return {};
    centre += step.head<2>();
    radius_m += step[2];
  }
  circle.centre = origin + centre;
  if (circle.centre.norm() < origin.norm()) return {};  // hollow towards the camera
  circle.radius_m = radius_m;
  return circle;
}

}  // namespace colonnade
