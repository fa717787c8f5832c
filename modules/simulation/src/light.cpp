// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "light.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kAmbient = 0.55;
constexpr double kLampGain = 1.5;
constexpr double kOcclusionDepth = 0.25;  ///< share of light lost in a corner
constexpr double kOcclusionReachM = 0.12;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distanceToSegment(const Eigen::Vector2d& p, const FloorLine& line) {
  const Eigen::Vector2d d = line.b - line.a;
  const double t = std::clamp((p - line.a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - line.a - t * d).norm();
}

}  // namespace

Light::Light(const World& world, const Building& building)
    : lamps_(world.lamps), outlines_(building.outline), ceiling_m_(building.ceiling_m) {}

bool Light::blocked(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const Eigen::Vector2d d = to - from;
  return std::any_of(outlines_.begin(), outlines_.end(), [&](const FloorLine& wall) {
    const Eigen::Vector2d e = wall.b - wall.a;
    const double determinant = cross(d, e);
    if (std::abs(determinant) < 1e-9) return false;
    const double t = cross(wall.a - from, e) / determinant;
    const double s = cross(wall.a - from, d) / determinant;
    return t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0;
  });
}

double Light::openness(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const {
  const auto corner = [](double distance) {
    return 1.0 - kOcclusionDepth * std::exp(-distance / kOcclusionReachM);
  };
  if (std::abs(normal.z()) < 0.5) return corner(p.z()) * corner(ceiling_m_ - p.z());
  double nearest = 1e9;
  for (const auto& line : outlines_)
    nearest = std::min(nearest, distanceToSegment(p.head<2>(), line));
  return corner(nearest);
}

double Light::brightness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const {
  // A little off the surface, or every wall would shade itself.
  const Eigen::Vector3d p = p_world + 0.01 * normal;
  double sum = lamps_.empty() ? 1.0 - kAmbient : 0.0;
  for (const auto& lamp : lamps_) {
    const Eigen::Vector3d to(lamp.centre.x() - p.x(), lamp.centre.y() - p.y(),
                             ceiling_m_ - p.z() + 0.05);
    const double square = to.squaredNorm();
    if (square > 64.0) continue;
    // Light scattered by the other surfaces reaches ceilings and faces turned away.
    const double facing = std::max(0.0, normal.dot(to)) / std::sqrt(square);
    if (facing <= 0.0 || blocked(p.head<2>(), lamp.centre)) continue;
    sum += kLampGain * lamp.brightness * facing / (1.0 + square);
  }
  return (kAmbient + sum) * openness(p_world, normal);
}

}  // namespace colonnade
