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
  Eigen::VectorXd G(state.x.size());
  const auto point = [&](int offset) {
    G(offset) = -state.x(offset + 1);
    G(offset + 1) = state.x(offset);
  };
  point(0);
  G(2) = 1.0;
  for (const Block& block : state.blocks) {
    if (block.block_kind == BlockKind::kAxis) {
      G(block.offset) = 1.0;
      continue;
    }
    point(block.offset);
    if (block.size() >= 3) G(block.offset + 2) = 1.0;
    if (block.size() == 4) G(block.offset + 3) = 0.0;
  }
  return G;
}

}  // namespace colonnade
