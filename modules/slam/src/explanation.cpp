// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/explanation.hpp"

namespace colonnade {

Explanation explanationOf(const DriveRecord& record, DriveSoFar& so_far,
                          const RangeBearingEstimator& estimator, bool loaded) {
  Explanation result;
  result.decisions = estimator.decisions();
  so_far.followHistory(result.decisions);
  result.T_world_robot = so_far.poses();
  result.sensor = so_far.sensorErrors();
  for (std::size_t i = 0; i < record.readings.size(); ++i)
    result.used.push_back(so_far.isUsed(i).value_or(result.decisions[i].has_value()));
  result.map = estimator.map();
  for (const LandmarkRecord& landmark : result.map)
    if (const auto identity = estimator.identityOf(landmark.id))
      result.identities.emplace(landmark.id, *identity);
  if (loaded) return result;
  result.map = moved(std::move(result.map), so_far.now().T_world_filter);
  const auto places = so_far.places();
  for (LandmarkRecord& landmark : result.map)
    if (const auto known = places.find(landmark.id); known != places.end())
      landmark.p_world = landmark.extent_a = landmark.extent_b = known->second;
  return result;
}

}  // namespace colonnade
