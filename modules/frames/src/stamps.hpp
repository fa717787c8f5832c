// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <cmath>
#include <cstdint>

namespace colonnade {

/// MRPT counts 100 ns ticks since 1601-01-01; UNIX time starts this many ticks later.
inline constexpr std::int64_t kUnixEpochTicks = 116444736000000000LL;
inline constexpr double kTicksPerSecond = 1e7;

/// UNIX seconds, to the nearest double (MRPT's own Clock::toDouble differs in the last digit).
inline double secondsOf(mrpt::Clock::time_point stamp) {
  return static_cast<double>(stamp.time_since_epoch().count() - kUnixEpochTicks) / kTicksPerSecond;
}

inline mrpt::Clock::time_point stampOf(double seconds) {
  return mrpt::Clock::time_point(
      mrpt::Clock::duration(std::llround(seconds * kTicksPerSecond) + kUnixEpochTicks));
}

/// From the UNIX epoch (recordings without a clock count from 0) to the year 2200.
inline bool isPlausibleStamp(double seconds) { return seconds >= 0.0 && seconds < 7258118400.0; }

}  // namespace colonnade
