// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_jump.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "statistics.hpp"
#include "surface_ends.hpp"

namespace colonnade {
namespace {

/// Sensors round surfaces off towards their outline; it is where depth has gone half of the way
/// to what lies behind, a few pixels farther on at most.
double outlineEnd(const SliceSurfaces& surfaces, const InverseLine& near, const InverseLine& far,
                  bool right, std::size_t limit) {
  constexpr double kReach = 12.0 / 580.0;
  constexpr double kRounded_m = 0.1;
  // Columns that few rows see are the fray of the outline.
  constexpr double kFray = 0.25;
  constexpr std::size_t kReference = 8;
  std::vector<int> pixels;
  for (std::size_t k = 0; k < std::min(kReference, near.columns()); ++k)
    pixels.push_back(surfaces.columns()[right ? near.last - 1 - k : near.first + k].pixels);
  const double enough = kFray * medianOf(pixels);
  std::size_t end_column = right ? near.last - 1 : near.first;
  for (std::size_t k = 0; k + 1 < near.columns() && surfaces.columns()[end_column].pixels < enough;
       ++k)
    right ? --end_column : ++end_column;
  const double end = surfaces.sAt(end_column);
  double s = end;
  const auto take = [&](std::size_t i) {
    if (surfaces.columns()[i].pixels < enough) return false;
    const double z_near = 1.0 / near.at(surfaces.sAt(i)), z_far = 1.0 / far.at(surfaces.sAt(i));
    const double beyond_m = 1.0 / surfaces.columns()[i].q - z_near;
    if (std::abs(surfaces.sAt(i) - end) > kReach || !(z_near > 0.0) ||
        beyond_m > std::min(0.5 * (z_far - z_near), kRounded_m))
      return false;
    s = surfaces.sAt(i);
    return true;
  };
  if (right)
    for (std::size_t i = near.last; i < limit && take(i); ++i) continue;
  else
    for (std::size_t i = near.first; i-- > limit && take(i);) continue;
  return s;
}

}  // namespace

std::optional<SliceCorner> jumpBetween(const SliceSurfaces& surfaces, const InverseLine& left,
                                       const InverseLine& right) {
  const SurfaceEnds ends(surfaces);
  const double s_left = surfaces.sAt(left.last - 1), s_right = surfaces.sAt(right.first);
  SliceCorner corner;
  corner.jump = true;
  corner.far_on_right = left.at(s_left) > right.at(s_right);
  InverseLine near = corner.far_on_right ? left : right;
  const InverseLine& far = corner.far_on_right ? right : left;
  const double half_px = 0.5 / surfaces.focal_px();
  corner.s = corner.far_on_right ? outlineEnd(surfaces, left, far, true, right.first) + half_px
                                 : outlineEnd(surfaces, right, far, false, left.last) - half_px;
  near = ends.withoutFray(near, corner.far_on_right);
  corner.q = near.at(corner.s);
  if (!(corner.q > 0.0 && far.at(corner.s) > 0.0)) return std::nullopt;
  corner.step_m = 1.0 / far.at(corner.s) - 1.0 / corner.q;
  const double least_step_m =
      surfaces.options().min_jump_m + 4.0 * surfaces.columnSigma(corner.s, near);
  if (corner.step_m < least_step_m) return std::nullopt;
  // Nothing nearer may stand between them: then that hides where the surface ends.
  for (std::size_t i = left.last; i < right.first; ++i)
    if (surfaces.columns()[i].q >
        1.01 * near.at(surfaces.sAt(i)) + 4.0 * std::sqrt(surfaces.columns()[i].variance))
      return std::nullopt;
  const double edge_px =
      surfaces.options().edge_sigma_px * (0.5 + 0.5 * surfaces.focal_px() / 580.0);
  const double hidden_m = ends.unresolved(near, corner.s);
  const double hidden_px = 0.5 * hidden_m / (hidden_m + kResolved_m);
  const double variance_s =
      (edge_px * edge_px + hidden_px * hidden_px) / (surfaces.focal_px() * surfaces.focal_px());
  const double variance_q =
      surfaces.noise().shared * ends.withHiddenRelief(near, corner.s).variance(corner.s);
  corner.covariance << variance_s, near.b * variance_s, near.b * variance_s,
      variance_q + near.b * near.b * variance_s;
  return corner;
}

}  // namespace colonnade
