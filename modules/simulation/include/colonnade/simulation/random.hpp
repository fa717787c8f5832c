// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>

namespace colonnade {

/// Random numbers that are the same with every standard library: the engine is fixed by the C++
/// standard, the distributions are written out here. Every use has a stream of its own, so that
/// one more sensor does not change the noise of the others.
class Random {
 public:
  Random(std::uint64_t seed, std::string_view stream);

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  /// Standard normal, by the polar form of Box and Muller (Marsaglia, 1964).
  double normal();

  /// Many at once, an order of magnitude faster: uniform in [0, 1) with 24 bits, and standard
  /// normal from a table of 16384 quantiles (unit variance, at most 4 sigma).
  void uniforms(float* values, std::size_t count);
  void normals(float* values, std::size_t count);

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
  std::uint64_t counter_;  ///< of the fast numbers
};

/// Smooth noise in [-1, 1] over the plane: random values on the whole coordinates, interpolated.
/// A function of its arguments alone.
double latticeNoise(double x, double y, std::uint32_t seed);

/// White noise in [-1, 1) of whole coordinates.
double cellNoise(std::int64_t x, std::int64_t y, std::uint32_t seed);

}  // namespace colonnade
