// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "colonnade/filter/smoother.hpp"

namespace colonnade {

/// Descends with the sightings within the gate of this probability; each of the others costs as
/// much as one at it.
void settle(Drive& drive, double probability, Smoothing& result);
double costOfUnused(Eigen::Index size, double probability);

/// Another drive is settled by way of trial only so often: of many or long ones the first.
std::size_t affordableTrials(const Drive& drive);

}  // namespace colonnade
