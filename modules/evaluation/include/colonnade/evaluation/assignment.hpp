// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace colonnade {

/// An estimate that may be this truth, at a cost from 0 to the limit of the gate.
struct Candidate {
  std::size_t estimate = 0;
  std::size_t truth = 0;
  double cost = 0.0;
};

/// The truth of each estimate, one to one, with the least sum of costs when an estimate and a truth
/// left alone together cost `limit`: the assignment of the GOSPA metric (Rahmathullah 2017, alpha =
/// 2), by the Hungarian method (Kuhn 1955) on each cluster of candidates that touch each other.
std::vector<std::optional<std::size_t>> assignOneToOne(std::size_t estimates, std::size_t truths,
                                                       const std::vector<Candidate>& candidates,
                                                       double limit);

}  // namespace colonnade
