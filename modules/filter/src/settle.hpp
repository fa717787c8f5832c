// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/filter/smoother.hpp"

namespace colonnade {

/// Descends with the sightings within the gate of this probability; each of the others costs as
/// much as one at it.
void settle(Drive& drive, double probability, Smoothing& result);
double costOfUnused(Eigen::Index size, double probability);

/// Other drives are settled by way of trial as long as these are left; of many or long ones the
/// first. A drive has at least one pose.
int affordableSteps(const Drive& drive);

}  // namespace colonnade
