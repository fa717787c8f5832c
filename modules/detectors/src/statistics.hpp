// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace colonnade {

/// The middle value (the upper of two); 0 for none. Reorders its argument.
template <class Number>
Number medianOf(std::span<Number> values) {
  if (values.empty()) return Number{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
template <class Number>
Number medianOf(std::vector<Number>& values) {
  return medianOf(std::span<Number>(values));
}

/// Standard deviation estimated from the median distance to the median. Reorders its argument.
inline double robustSpread(std::span<double> values) {
  const double centre = medianOf(values);
  for (auto& value : values) value = std::abs(value - centre);
  return 1.4826 * medianOf(values);
}

}  // namespace colonnade
