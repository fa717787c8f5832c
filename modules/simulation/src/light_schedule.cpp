// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/light_schedule.hpp"

#include <algorithm>

namespace colonnade {

Eigen::Vector3d LightSchedule::lightAt(double time_s, double driven_m) const {
  if (points.empty()) return Eigen::Vector3d::Ones();
  const double now = by_time ? time_s : driven_m;
  const auto next = std::upper_bound(points.begin(), points.end(), now,
                                     [](double at, const Point& point) { return at < point.at; });
  if (next == points.begin()) return points.front().light;
  if (next == points.end()) return points.back().light;
  const auto& before = *(next - 1);
  const double share = (now - before.at) / (next->at - before.at);
  return before.light + share * (next->light - before.light);
}

}  // namespace colonnade
