// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

namespace colonnade {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * kPi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / kPi; }

/// The same angle in [-pi, pi].
inline double wrapAngle(double angle) { return std::remainder(angle, 2.0 * kPi); }

/// The same direction modulo a quarter turn, in [-pi/4, pi/4]: what two walls of one building
/// share.
inline double wrapQuarterTurn(double angle) { return std::remainder(angle, kPi / 2.0); }

}  // namespace colonnade
