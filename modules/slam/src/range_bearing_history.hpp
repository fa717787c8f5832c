// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// Which landmark each reading was held to be of, for several histories that share their past: a
/// tree whose leaves are the histories of today.
class ReadingHistories {
 public:
  using Leaf = std::int32_t;
  static constexpr Leaf kRoot = -1;

  Leaf add(Leaf parent, std::optional<LandmarkId> landmark) {
    nodes_.push_back({landmark, parent});
    return static_cast<Leaf>(nodes_.size()) - 1;
  }

  /// All decisions of a history, oldest first.
  std::vector<std::optional<LandmarkId>> path(Leaf leaf) const {
    auto all = decided_;
    const auto open = openPath(leaf);
    all.insert(all.end(), open.begin(), open.end());
    return all;
  }

  /// A number that two histories share when their last `length` decisions agree.
  std::uint64_t recent(Leaf leaf, int length) const {
    std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
    for (; leaf != kRoot && length > 0; leaf = node(leaf).parent, --length)
      hash = (hash ^ static_cast<std::uint64_t>(
                         node(leaf).landmark ? number(*node(leaf).landmark) + 1 : 0)) *
             1099511628211ULL;
    return hash;
  }

  /// Drops what no history of today remembers once there is much of it; renames the leaves.
  void tidy(std::span<Leaf> leaves);

 private:
  struct Node {
    std::optional<LandmarkId> landmark;
    Leaf parent = kRoot;
  };
  const Node& node(Leaf leaf) const { return nodes_[static_cast<std::size_t>(leaf)]; }
  std::vector<std::optional<LandmarkId>> openPath(Leaf leaf) const;

  std::vector<Node> nodes_;
  std::vector<std::optional<LandmarkId>> decided_;  ///< what all histories agree on
};

}  // namespace colonnade
