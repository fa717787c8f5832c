// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/gate.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace colonnade {

double chiSquareQuantile(double probability, int degrees_of_freedom) {
  return quantile(boost::math::chi_squared_distribution<double>(degrees_of_freedom), probability);
}

}  // namespace colonnade
