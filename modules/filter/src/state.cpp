// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/state.hpp"

#include <algorithm>

namespace colonnade {

const Block* State::find(LandmarkId id) const {
  // Blocks stay in the order of birth, and identities grow with birth.
  const auto at = std::lower_bound(blocks.begin(), blocks.end(), id,
                                   [](const Block& b, LandmarkId wanted) { return b.id < wanted; });
  return at != blocks.end() && at->id == id ? &*at : nullptr;
}

Block* State::find(LandmarkId id) {
  return const_cast<Block*>(static_cast<const State&>(*this).find(id));
}

Eigen::VectorXd worldTurn(const State& state) {
  Eigen::VectorXd G = Eigen::VectorXd::Zero(state.x.size());
  const auto turn = [&](int offset, BlockLayout layout) {
    if (layout.point >= 0) {
      const int at = offset + layout.point;
      G.segment<2>(at) << -state.x(at + 1), state.x(at);
    }
    if (layout.direction >= 0) G(offset + layout.direction) = 1.0;
  };
  turn(0, kRobotLayout);
  for (const Block& block : state.blocks) turn(block.offset, layoutOf(block.block_kind));
  return G;
}

}  // namespace colonnade
