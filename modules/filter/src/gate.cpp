// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/gate.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <limits>

namespace colonnade {

double chiSquareQuantile(double probability, int degrees_of_freedom) {
  if (probability >= 1.0) return std::numeric_limits<double>::infinity();
  return quantile(boost::math::chi_squared_distribution<double>(degrees_of_freedom), probability);
}

}  // namespace colonnade
