// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_history.hpp"

#include <algorithm>

namespace colonnade {

std::vector<std::optional<LandmarkId>> ReadingHistories::openPath(Leaf leaf) const {
  std::vector<std::optional<LandmarkId>> path;
  for (; leaf != kRoot; leaf = node(leaf).parent) path.push_back(node(leaf).landmark);
  std::reverse(path.begin(), path.end());
  return path;
}

void ReadingHistories::tidy(std::span<Leaf> leaves) {
  constexpr std::size_t kMostNodes = 1 << 17;
  if (nodes_.size() < kMostNodes || leaves.empty()) return;
  std::vector<std::vector<std::optional<LandmarkId>>> paths;
  for (const Leaf leaf : leaves) paths.push_back(openPath(leaf));
  std::size_t common = paths.front().size();
  for (const auto& path : paths) {
    const auto end = paths.front().begin() + static_cast<std::ptrdiff_t>(common);
    const auto apart = std::mismatch(paths.front().begin(), end, path.begin(), path.end());
    common = static_cast<std::size_t>(apart.first - paths.front().begin());
  }
  decided_.insert(decided_.end(), paths.front().begin(),
                  paths.front().begin() + static_cast<std::ptrdiff_t>(common));
  nodes_.clear();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    leaves[i] = kRoot;
    for (std::size_t k = common; k < paths[i].size(); ++k) leaves[i] = add(leaves[i], paths[i][k]);
  }
}

}  // namespace colonnade
