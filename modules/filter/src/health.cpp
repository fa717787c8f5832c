// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/health.hpp"

namespace colonnade {

void InnovationHealth::accept(LandmarkKind kind, double distance2, int degrees_of_freedom) {
  Sum& sum = sums_[index(kind)];
  sum.distance2 += distance2;
  sum.degrees_of_freedom += static_cast<std::size_t>(degrees_of_freedom);
  ++sum.count;
}

double InnovationHealth::meanNis(LandmarkKind kind) const {
  const Sum& sum = sums_[index(kind)];
  return sum.count == 0 ? 0.0 : sum.distance2 / static_cast<double>(sum.degrees_of_freedom);
}

}  // namespace colonnade
