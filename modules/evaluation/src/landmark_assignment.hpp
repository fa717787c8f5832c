// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "colonnade/evaluation/assignment.hpp"
#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// Landmarks of one kind: as estimated, the same in the truth's world, and the true ones.
struct LandmarkLists {
  const LandmarkMap estimate;
  const LandmarkMap aligned;
  const LandmarkMap truth;
};

/// Root mean square over a sum of squares; nothing without any.
std::optional<double> rootMean(double sum_of_squares, double weight);

/// One to one, first among the truths that were seen often enough, then among the others.
std::vector<std::optional<std::size_t>> assignSeenFirst(
    std::size_t estimates, std::size_t truths, const std::vector<Candidate>& candidates,
    double limit, const std::function<bool(std::size_t)>& seen);

}  // namespace colonnade
