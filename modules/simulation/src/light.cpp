// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "light.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kAmbient = 0.50;
constexpr double kLampGain = 2.0;
constexpr double kOcclusionDepth = 0.25;  ///< share of light lost in a corner
constexpr double kOcclusionReachM = 0.12;
constexpr double kReachM = 8.0;       ///< of a lamp
constexpr double kCoverDepth = 0.45;  ///< share of light lost under a table
constexpr double kCoverSoftM = 0.30;  ///< width of the edge of its shadow

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
    : low_(building.low), ceiling_m_(building.ceiling_m) {
  for (const auto& lamp : world.lamps) {
    LitPart part{lamp, {}};
    for (const auto& line : building.outline) {
      if (distanceToSegment(lamp.centre, line) < kReachM) part.around.push_back(line);
    }
    parts_.push_back(std::move(part));
  }
  for (const auto& obstacle : building.obstacles) {
    if (obstacle.bottom_m > 0.0) covers_.push_back(obstacle);
  }
  const Eigen::Vector2d size = building.high - building.low;
  columns_ = static_cast<int>(std::ceil(size.x()));
  rows_ = static_cast<int>(std::ceil(size.y()));
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d middle = low_ + Eigen::Vector2d(column + 0.5, row + 0.5);
      auto& place = places_.emplace_back();
      for (const auto& line : building.outline) {
        // Half a diagonal and what is left of the occlusion five reaches away.
        if (distanceToSegment(middle, line) < 0.71 + 5.0 * kOcclusionReachM) place.push_back(line);
      }
    }
  }
}

const std::vector<FloorLine>& Light::near(const Eigen::Vector2d& p) const {
  const auto index = [](double x, int count) {
    return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1);
  };
  return places_[static_cast<std::size_t>(index(p.y() - low_.y(), rows_) * columns_ +
                                          index(p.x() - low_.x(), columns_))];
}

bool Light::blocked(const Eigen::Vector3d& p, const LitPart& part) const {
  const Eigen::Vector2d from = p.head<2>();
  const Eigen::Vector2d d = part.lamp.centre - from;
  return std::any_of(part.around.begin(), part.around.end(), [&](const FloorLine& wall) {
    const Eigen::Vector2d e = wall.b - wall.a;
    const double determinant = cross(d, e);
    if (std::abs(determinant) < 1e-9) return false;
    const double t = cross(wall.a - from, e) / determinant;
    const double s = cross(wall.a - from, d) / determinant;
    return t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0 &&
           p.z() + t * (ceiling_m_ - p.z()) < wall.height_m;
  });
}

double Light::openness(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const {
  const auto corner = [](double distance) {
    return 1.0 - kOcclusionDepth * std::exp(-distance / kOcclusionReachM);
  };
  if (std::abs(normal.z()) < 0.5) return corner(p.z()) * corner(ceiling_m_ - p.z());
  double nearest = 1e9;
  for (const auto& line : near(p.head<2>())) {
    if (line.height_m < p.z()) continue;
    nearest = std::min(nearest, distanceToSegment(p.head<2>(), line));
  }
  double open = corner(nearest);
  for (const auto& cover : covers_) {
    if (cover.bottom_m <= p.z()) continue;
    // How deep below the cover: 0 at its rim.
    double depth = 1e9;
    for (std::size_t i = 0; i < cover.outline.size(); ++i) {
      const Eigen::Vector2d& a = cover.outline[i];
      const Eigen::Vector2d b = cover.outline[(i + 1) % cover.outline.size()];
      depth = std::min(depth, -cross((b - a).normalized(), p.head<2>() - a));
    }
    open *= 1.0 - kCoverDepth * std::clamp(0.5 + depth / kCoverSoftM, 0.0, 1.0);
  }
  return open;
}

double Light::brightness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const {
  // A little off the surface, or every wall would shade itself.
  const Eigen::Vector3d p = p_world + 0.01 * normal;
  double sum = parts_.empty() ? 1.0 - kAmbient : 0.0;
  for (const auto& part : parts_) {
    const Lamp& lamp = part.lamp;
    const Eigen::Vector3d to(lamp.centre.x() - p.x(), lamp.centre.y() - p.y(),
                             ceiling_m_ - p.z() + 0.05);
    const double square = to.squaredNorm();
    if (square > kReachM * kReachM) continue;
    // Light scattered by the other surfaces reaches ceilings and faces turned away.
    const double facing = std::max(0.0, normal.dot(to)) / std::sqrt(square);
    if (facing <= 0.0 || blocked(p, part)) continue;
    sum += kLampGain * lamp.brightness * facing / (1.0 + square);
  }
  return (kAmbient + sum) * openness(p_world, normal);
}

}  // namespace colonnade
