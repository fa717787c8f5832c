// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/random.hpp"

#include <cmath>
#include <vector>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea and Flood, 2014).
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

std::uint64_t streamSeed(std::uint64_t seed, std::string_view stream) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char letter : stream) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
  }
  return mixed(mixed(seed) ^ hash);
}

constexpr std::size_t kTableBits = 14;
constexpr std::size_t kTableSize = std::size_t{1} << kTableBits;
constexpr std::uint64_t kTableMask = kTableSize - 1;

/// The quantiles (i + 1/2) / size of the standard normal distribution, scaled to unit variance.
std::vector<float> normalTable() {
  std::vector<double> upper(kTableSize / 2);
  double z = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const double tail = 0.5 - (static_cast<double>(i) + 0.5) / static_cast<double>(kTableSize);
    for (int round = 0; round < 6; ++round) {  // Newton from the quantile before
      const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
      z += (0.5 * std::erfc(z / std::sqrt(2.0)) - tail) / density;
    }
    upper[i] = z;
    squares += z * z;
  }
  const double scale = std::sqrt(static_cast<double>(upper.size()) / squares);
  std::vector<float> table(kTableSize);
  for (std::size_t i = 0; i < upper.size(); ++i) {
    table[kTableSize / 2 + i] = static_cast<float>(scale * upper[i]);
    table[kTableSize / 2 - 1 - i] = static_cast<float>(-scale * upper[i]);
  }
  return table;
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view stream)
    : engine_(streamSeed(seed, stream)), counter_(mixed(streamSeed(seed, stream))) {}

void Random::uniforms(float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(mixed(counter_++) >> 40) * 0x1.0p-24F;
  }
}

void Random::normals(float* values, std::size_t count) {
  static const std::vector<float> table = normalTable();
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits = i % 4 == 0 ? mixed(counter_++) : bits >> kTableBits;
    values[i] = table[bits & kTableMask];
  }
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  for (;;) {
    const double a = 2.0 * uniform() - 1.0;
    const double b = 2.0 * uniform() - 1.0;
    const double square = a * a + b * b;
    if (square >= 1.0 || square == 0.0) continue;
    const double factor = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = b * factor;
    has_spare_ = true;
    return a * factor;
  }
}

double cellNoise(std::int64_t x, std::int64_t y, std::uint32_t seed) {
  std::uint32_t hash = seed * 0x9e3779b9U;  // the 32-bit finaliser of MurmurHash3, twice
  for (const std::int64_t coordinate : {x, y}) {
    hash ^= static_cast<std::uint32_t>(coordinate);
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bU;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35U;
    hash ^= hash >> 16;
  }
  return static_cast<double>(hash) * 0x1.0p-31 - 1.0;
}

double latticeNoise(double x, double y, std::uint32_t seed) {
  const double x_floor = std::floor(x);
  const double y_floor = std::floor(y);
  const auto i = static_cast<std::int64_t>(x_floor);
  const auto j = static_cast<std::int64_t>(y_floor);
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double a = smooth(x - x_floor);
  const double b = smooth(y - y_floor);
  const double low = (1.0 - a) * cellNoise(i, j, seed) + a * cellNoise(i + 1, j, seed);
  const double high = (1.0 - a) * cellNoise(i, j + 1, seed) + a * cellNoise(i + 1, j + 1, seed);
  return (1.0 - b) * low + b * high;
}

}  // namespace colonnade
