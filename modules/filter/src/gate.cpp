// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/gate.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <limits>
#include <map>
#include <utility>

namespace colonnade {

double chiSquareQuantile(double probability, int degrees_of_freedom) {
  if (probability >= 1.0) return std::numeric_limits<double>::infinity();
  // Every pairing of a frame asks for the same few bounds, and each costs an iteration.
  thread_local std::map<std::pair<double, int>, double> known;
  const std::pair key(probability, degrees_of_freedom);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return known.emplace(key, quantile(distribution, probability)).first->second;
}

}  // namespace colonnade
