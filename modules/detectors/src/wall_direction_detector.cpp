// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/wall_direction_detector.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "plane_fit.hpp"

namespace colonnade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Runs of neighbouring columns on one surface.
std::vector<Points> chains(const DepthProfile& profile, const WallDirectionOptions& options) {
  std::vector<Points> result(1);
  for (const auto& column : profile.columns) {
    if (!column.valid() || column.z > options.max_range_m) continue;
    const Eigen::Vector2d p = column.point();
    auto& chain = result.back();
    if (!chain.empty() &&
        (p - chain.back()).norm() > options.jump_m + 3.0 * kinectDepthSigma(column.z)) {
      result.emplace_back();
    }
    result.back().push_back(p);
  }
  return result;
}

/// Iterative end point fit: cuts [first, last] at the point farthest from the chord while that is
/// too far.
void split(const Points& chain, std::size_t first, std::size_t last, double tolerance_m,
           std::vector<Points>& pieces) {
  if (last - first < 4) return;
  const Eigen::Vector2d along = (chain[last] - chain[first]).normalized();
  const Eigen::Vector2d normal(-along.y(), along.x());
  std::size_t farthest = first;
  double distance_m = 0.0;
  double excess = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double off = std::abs(normal.dot(chain[i] - chain[first]));
    if (off > distance_m) {
      distance_m = off;
      farthest = i;
      excess = off - tolerance_m - 2.0 * kinectDepthSigma(chain[i].y());
    }
  }
  if (excess > 0.0 && farthest > first && farthest < last) {
    split(chain, first, farthest, tolerance_m, pieces);
    split(chain, farthest, last, tolerance_m, pieces);
    return;
  }
  pieces.emplace_back(chain.begin() + static_cast<std::ptrdiff_t>(first),
                      chain.begin() + static_cast<std::ptrdiff_t>(last) + 1);
}

/// Fits without the points that lie off; twice.
SliceLine fitRobustly(Points& points, double tolerance_m) {
  SliceLine line = fitSliceLine(points);
  for (int round = 0; round < 2; ++round) {
    const Eigen::Vector2d normal(-line.along.y(), line.along.x());
    const Eigen::Vector2d centre = line.centre;
    Points inliers;
    for (const auto& p : points) {
      if (std::abs(normal.dot(p - centre)) < 0.5 * tolerance_m + 1.5 * kinectDepthSigma(p.y())) {
        inliers.push_back(p);
      }
    }
    if (inliers.size() < 8 || inliers.size() * 10 < points.size() * 6) break;
    points = std::move(inliers);
    line = fitSliceLine(points);
  }
  return line;
}

}  // namespace

std::vector<WallDirection> WallDirectionDetector::detect(const Frame& frame) const {
  return detect(makeDepthProfile(frame, profile_));
}

std::vector<WallDirection> WallDirectionDetector::detect(const DepthProfile& profile) const {
  std::vector<WallDirection> walls;
  for (const auto& chain : chains(profile, options_)) {
    if (chain.size() < 10) continue;
    std::vector<Points> pieces;
    split(chain, 0, chain.size() - 1, options_.tolerance_m, pieces);
    for (auto& piece : pieces) {
      const SliceLine line = fitRobustly(piece, options_.tolerance_m);
      const double begin = line.along.dot(piece.front() - line.centre);
      const double end = line.along.dot(piece.back() - line.centre);
      const double length_m = std::abs(end - begin);
      if (length_m < options_.min_length_m || line.points < 10) continue;
      // Neighbouring columns share their error, and depth bends slowly over the image.
      constexpr double kShared = 10.0;
      const double error_m = std::max(line.rms_m, 0.3 * kinectDepthSigma(line.centre.y()));
      WallDirection wall;
      wall.sigma = std::hypot(options_.min_sigma, error_m * std::sqrt(kShared / line.spread_m2));
      if (wall.sigma > options_.max_sigma) continue;
      const Eigen::Vector2d along = profile.R_robot_slice * line.along;
      wall.direction = wrapQuarterTurn(std::atan2(along.y(), along.x()));
      wall.length_m = length_m;
      wall.p_robot_a = profile.toRobot(line.centre + begin * line.along);
      wall.p_robot_b = profile.toRobot(line.centre + end * line.along);
      walls.push_back(wall);
    }
  }
  std::stable_sort(walls.begin(), walls.end(), [](const WallDirection& a, const WallDirection& b) {
    return a.length_m > b.length_m;
  });
  return walls;
}

}  // namespace colonnade
