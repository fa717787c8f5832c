// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pairing.hpp"

namespace colonnade {

/// The rows of nu and S that belong to a set of pairings, in its order.
std::vector<Eigen::Index> rowsOf(const JointPairings& joint, const std::vector<std::size_t>& set);

}  // namespace colonnade
