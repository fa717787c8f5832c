// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "corner_in_band.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

std::optional<bool> isSeenIn(const InverseColumns& band, const InverseColumns& columns,
                             const SliceCorner& corner, double focal_px) {
  const auto sideIn = [&](const InverseLine& line) -> std::optional<InverseLine> {
    const double low = columns[line.first].s, high = columns[line.last - 1].s;
    InverseColumns inside;
    for (const auto& column : band)
      if (column.s >= low && column.s <= high) inside.push_back(column);
    if (inside.size() < 3 || inside.size() * 2 < line.columns()) return std::nullopt;
    InverseLineFits fits(inside);
    fits.assumeScale(std::max(1.0, corner.noise_scale));
    return fits.fit(0, inside.size());
  };
  const auto left = sideIn(*corner.left);
  const auto right = sideIn(*corner.right);
  if (!left || !right) return std::nullopt;
  const auto nearBy = [&](const InverseLine& seen, const InverseLine& line) {
    const double variance =
        corner.noise_shared * (seen.variance(line.middle) + line.covariance(0, 0));
    return std::abs(seen.at(line.middle) - line.q_middle) <
           0.02 * line.q_middle + 3.0 * std::sqrt(variance);
  };
  if (corner.jump) {
    const auto& near = corner.far_on_right ? *left : *right;
    const auto& far = corner.far_on_right ? *right : *left;
    const auto& whole = corner.far_on_right ? *corner.left : *corner.right;
    if (!nearBy(near, whole) && near.at(whole.middle) > whole.q_middle)
      return std::nullopt;  // at these heights something stands before it
    const double step_m =
        1.0 / std::max(far.at(corner.s), 1e-3) - 1.0 / std::max(near.at(corner.s), 1e-3);
    const double z_near = 1.0 / std::max(near.at(corner.s), 1e-3);
    const double sigma_m =
        std::sqrt(corner.noise_shared * near.variance(corner.s)) * z_near * z_near;
    return nearBy(near, whole) && step_m + 3.0 * sigma_m > 0.5 * corner.step_m;
  }
  if (!nearBy(*left, *corner.left) || !nearBy(*right, *corner.right)) return false;
  const auto there = intersection(*left, *right, corner.noise_shared);
  if (!there) return false;
  const double tolerance =
      3.0 / focal_px + 3.0 * std::sqrt(there->covariance(0, 0) + corner.covariance(0, 0));
  return std::abs(there->s - corner.s) < tolerance;
}

}  // namespace colonnade
