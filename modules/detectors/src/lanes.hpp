// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>

namespace colonnade {

/// Vectors of numbers to and from memory of any alignment. Inlined, so that they are compiled for
/// the processor their kernel is compiled for.
template <class Lanes, class Number>
inline __attribute__((always_inline)) void load(Lanes& lanes, const Number* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
template <class Lanes, class Number>
inline __attribute__((always_inline)) void store(const Lanes& lanes, Number* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

}  // namespace colonnade
