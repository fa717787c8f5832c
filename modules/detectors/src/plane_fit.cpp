// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "plane_fit.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

SliceLine fitSliceLine(const std::vector<Eigen::Vector2d>& points) {
  SliceLine line;
  line.points = static_cast<int>(points.size());
  if (points.empty()) return line;
  for (const auto& p : points) line.centre += p;
  line.centre /= static_cast<double>(points.size());
  double xx = 0.0;
  double xz = 0.0;
  double zz = 0.0;
  for (const auto& p : points) {
    const Eigen::Vector2d d = p - line.centre;
    xx += d.x() * d.x();
    xz += d.x() * d.y();
    zz += d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xz, xx - zz);  // of the larger axis
  line.along = {std::cos(angle), std::sin(angle)};
  if (line.along.x() < 0.0) line.along = -line.along;
  const double half_difference = std::hypot(0.5 * (xx - zz), xz);
  line.spread_m2 = 0.5 * (xx + zz) + half_difference;
  line.rms_m = std::sqrt(std::max(0.0, 0.5 * (xx + zz) - half_difference) /
                         static_cast<double>(points.size()));
  return line;
}

}  // namespace colonnade
