// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace colonnade {

/// As std::lround, halves away from zero, without the call (but for the number next below a half);
/// for magnitudes below 1e9.
inline int roundToInt(double x) { return static_cast<int>(x < 0.0 ? x - 0.5 : x + 0.5); }

struct Pixel {
  int u = 0, v = 0;
};
/// Nothing for what is not finite or farther out than any image reaches.
inline std::optional<Pixel> nearestPixel(const Eigen::Vector2d& p_px) {
  constexpr double kFarthest_px = 1e6;
  if (!(std::abs(p_px.x()) <= kFarthest_px && std::abs(p_px.y()) <= kFarthest_px))
    return std::nullopt;
  return Pixel{roundToInt(p_px.x()), roundToInt(p_px.y())};
}

}  // namespace colonnade
