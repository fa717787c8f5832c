// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_walk.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kNearM = 0.1;
constexpr double kToleranceM = 0.01;  ///< of depth: a point and the surface it lies on
constexpr double kTolerance = 0.004;  ///< and relative

/// Narrows [low, high] to where start + share * change >= 0; false when nothing is left.
bool clip(double start, double change, double& low, double& high) {
  if (std::abs(change) < 1e-12) return start >= 0.0;
  const double crossing = -start / change;
  if (change > 0.0) {
    low = std::max(low, crossing);
  } else {
    high = std::min(high, crossing);
  }
  return low < high;
}

bool unhidden(const Surfaces& surfaces, const Eigen::Vector2d& pixel, double inverse) {
  const cv::Mat& seen = surfaces.inverse;
  const double tolerance = inverse * (kTolerance + kToleranceM * inverse);
  const int column = static_cast<int>(std::lround(pixel.x()));
  const int row = static_cast<int>(std::lround(pixel.y()));
  const auto lies = [&](int r, int c) {
    return seen.at<float>(r, c) > 0.0F &&
           std::abs(surfaces.inverseAt(r, c, pixel.x(), pixel.y()) - inverse) < tolerance;
  };
  if (lies(row, column)) return true;
  for (int r = std::max(0, row - 1); r <= std::min(seen.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(seen.cols - 1, column + 1); ++c) {
      if (lies(r, c)) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<ImageLine> projectedLine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const PinholeCamera& camera) {
  double low = 0.0, high = 1.0;
  if (!clip(a.z() - kNearM, b.z() - a.z(), low, high)) return std::nullopt;
  const Eigen::Vector3d near = a + low * (b - a), far = a + high * (b - a);
  const auto project = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return {camera.cx_px + camera.fx_px * p.x() / p.z(),
            camera.cy_px + camera.fy_px * p.y() / p.z()};
  };
  const Eigen::Vector2d from = project(near), change = project(far) - from;
  const double inverse = 1.0 / near.z(), inverse_change = 1.0 / far.z() - inverse;
  low = 0.0, high = 1.0;
  if (!clip(from.x(), change.x(), low, high) || !clip(from.y(), change.y(), low, high) ||
      !clip(camera.width_px - 1 - from.x(), -change.x(), low, high) ||
      !clip(camera.height_px - 1 - from.y(), -change.y(), low, high))
    return std::nullopt;
  ImageLine line{from + low * change, from + high * change, inverse + low * inverse_change,
                 inverse + high * inverse_change};
  line.steps = std::max(1, static_cast<int>(std::ceil((line.to - line.from).norm())));
  return line;
}

std::vector<bool> unhiddenSteps(const ImageLine& line, const Surfaces& surfaces) {
  std::vector<bool> result(static_cast<std::size_t>(line.steps) + 1);
  for (int step = 0; step <= line.steps; ++step) {
    result[static_cast<std::size_t>(step)] =
        unhidden(surfaces, line.at(step), line.inverseAt(step));
  }
  return result;
}

}  // namespace colonnade
