// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// The same of whole numbers from `least` to `most`, by counting how often there is each: sooner
/// done than ordering where there are many.
template <int least, int most>
int medianByCounting(std::span<const int> values) {
  if (values.empty()) return 0;
  std::array<std::uint32_t, most - least + 1> counts{};
  for (const int value : values) ++counts[static_cast<std::size_t>(value - least)];
  std::size_t up_to = counts[0], at = 0;
  while (up_to <= values.size() / 2) up_to += counts[++at];
  return least + static_cast<int>(at);
}

/// Standard deviation estimated from the median distance to the median. Reorders its argument.
inline double robustSpread(std::span<double> values) {
  const double centre = medianOf(values);
  for (auto& value : values) value = std::abs(value - centre);
  return 1.4826 * medianOf(values);
}

}  // namespace colonnade
