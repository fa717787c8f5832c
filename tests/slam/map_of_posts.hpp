// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/slam/resumption.hpp"

namespace colonnade::testing {

/// A map of landmark readings, numbered from 1, without errors in common.
inline Resumption mapOf(const std::vector<Eigen::Vector2d>& posts, double sigma_m) {
  Resumption from;
  from.map.source = SavedMap::Source::kReadings;
  State& state = from.map.state;
  const auto size = static_cast<Eigen::Index>(3 + 2 * posts.size());
  state.x.setZero(size);
  state.P = sigma_m * sigma_m * Eigen::MatrixXd::Identity(size, size);
  for (const Eigen::Vector2d& post : posts) {
    const int number = static_cast<int>(state.blocks.size());
    state.blocks.push_back(
        {LandmarkId{number + 1}, BlockKind::kPoint, LandmarkKind::kPillarEdge, 3 + 2 * number, {}});
    state.x.segment<2>(3 + 2 * number) = post;
  }
  return from;
}

}  // namespace colonnade::testing
