// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// Which landmark each identity of a log is: the one most of its readings went to, each landmark
/// one identity, the pairs with most readings first. From a pair for each reading; identities below
/// 0 are none.
std::map<int, LandmarkId> bearersOf(const std::vector<std::pair<int, LandmarkId>>& readings);

/// How far decisions agree with the identities a log tells, each borne as above.
struct IdentityScore {
  std::size_t readings = 0;    ///< whose identity the log tells
  std::size_t associated = 0;  ///< with a landmark
  std::size_t right = 0;       ///< of those, with the landmark of their identity
  std::size_t identities = 0;
  double rightShare() const {
    return associated == 0 ? 0.0 : static_cast<double>(right) / static_cast<double>(associated);
  }
};
IdentityScore scoreIdentities(const std::vector<std::optional<LandmarkId>>& decisions,
                              const std::vector<int>& identities);

}  // namespace colonnade
