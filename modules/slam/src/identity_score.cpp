// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/identity_score.hpp"

#include <algorithm>
#include <set>

namespace colonnade {

std::map<int, LandmarkId> bearersOf(const std::vector<std::pair<int, LandmarkId>>& readings) {
  std::map<std::pair<int, LandmarkId>, std::size_t> counts;
  for (const auto& reading : readings)
    if (reading.first >= 0) ++counts[reading];
  std::vector<std::pair<std::size_t, std::pair<int, LandmarkId>>> order;
  for (const auto& [pair, count] : counts) order.emplace_back(count, pair);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::map<int, LandmarkId> bearers;
  std::set<LandmarkId> taken;
  for (const auto& [count, pair] : order)
    if (!bearers.contains(pair.first) && taken.insert(pair.second).second) bearers.insert(pair);
  return bearers;
}

IdentityScore scoreIdentities(const std::vector<std::optional<LandmarkId>>& decisions,
                              const std::vector<int>& identities) {
  IdentityScore score;
  std::vector<std::pair<int, LandmarkId>> associated;
  std::set<int> told;
  for (std::size_t i = 0; i < std::min(decisions.size(), identities.size()); ++i) {
    if (identities[i] < 0) continue;
    ++score.readings;
    told.insert(identities[i]);
    if (decisions[i]) associated.emplace_back(identities[i], *decisions[i]);
  }
  score.identities = told.size();
  score.associated = associated.size();
  const auto bearers = bearersOf(associated);
  score.right = static_cast<std::size_t>(
      std::count_if(associated.begin(), associated.end(), [&](const auto& reading) {
        const auto bearer = bearers.find(reading.first);
        return bearer != bearers.end() && bearer->second == reading.second;
      }));
  return score;
}

}  // namespace colonnade
