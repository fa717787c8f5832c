// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "line_samples.hpp"

namespace colonnade {

/// Where a second straight line begins, if two explain the samples so much better than one that
/// noise cannot be the reason: the feet of a wall and of a door in it, some centimetres farther
/// back, look like one slanting line (F test for a break at an unknown place, after G. C. Chow,
/// "Tests of equality between sets of coefficients in two linear regressions", Econometrica 1960).
std::optional<std::size_t> breakOf(SampleSpan samples, double correlated_samples);

}  // namespace colonnade
