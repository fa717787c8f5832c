// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/consistency.hpp"

#include <limits>
#include <string>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/filter/gate.hpp"

namespace colonnade {

Band chiSquareBand(std::size_t dof, double probability) {
  if (dof < 1 || dof > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error("a chi-square band needs one degree of freedom or more, not " +
                std::to_string(dof));
  if (!(probability > 0.0 && probability < 1.0))
    throw Error("the probability of a band lies between 0 and 1, not at " +
                formatDouble(probability));
  const auto quantile = [&](double p) { return chiSquareQuantile(p, static_cast<int>(dof)); };
  return {quantile(0.5 * (1.0 - probability)), quantile(0.5 * (1.0 + probability))};
}

Band consistencyBand(std::size_t runs, std::size_t dof, double probability) {
  const Band sum = chiSquareBand(runs * dof, probability);
  const auto count = static_cast<double>(runs * dof);
  return {sum.low / count, sum.high / count};
}

}  // namespace colonnade
