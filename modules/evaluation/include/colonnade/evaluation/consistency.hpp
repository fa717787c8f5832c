// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace colonnade {

/// An interval of numbers, both ends included.
struct Band {
  double low = 0.0;
  double high = 0.0;
  bool contains(double value) const { return low <= value && value <= high; }
};

/// The two-sided band a chi-square variable with `dof` degrees of freedom lies in with this
/// probability, equal shares left out at both ends (Bar-Shalom 2001, section 5.4.2). Throws Error
/// for dof below 1 or a probability outside (0, 1).
Band chiSquareBand(std::size_t dof, double probability = 0.95);

/// The two-sided band for the mean over `runs` independent runs of a squared error with `dof`
/// degrees of freedom (NEES of a planar pose: 3), divided by dof as nees_mean is, so that it
/// encloses 1: chiSquareBand(runs * dof) / (runs * dof). The runs must be independent (other
/// seeds); the poses of one run are not, since an error stays for many frames, and must not be
/// counted as runs.
Band consistencyBand(std::size_t runs, std::size_t dof, double probability = 0.95);

}  // namespace colonnade
