// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "duplicates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "settle.hpp"

namespace colonnade {
namespace {

constexpr double kNear = 10.0;  ///< deviations of a reading
/// Hardly ever together: in one of so many sightings of the rarer one.
constexpr std::size_t kHardlyEver = 10;
/// So many of its sightings with others tell that it is seen alone for a reason.
constexpr std::size_t kFewestInCompany = 3;

/// What the sightings in use say of one point.
struct Seen {
  std::vector<std::size_t> poses;  ///< ascending; one for each sighting
  double numbers = 0.0;            ///< that were measured
  double spread2 = 0.0;            ///< m^2, the mean of readings with range
};

std::vector<Seen> seenOf(const Drive& drive) {
  std::vector<Seen> points(drive.points_world.size());
  for (const Drive::Sighting& sighting : drive.sightings) {
    const Measurement& m = sighting.measurement;
    if (!sighting.used || !m.hasRange()) continue;
    Seen& point = points[sighting.point];
    point.poses.push_back(sighting.pose);
    point.numbers += static_cast<double>(m.z.size());
    point.spread2 += m.R(1, 1) + m.z(1) * m.z(1) * m.R(0, 0);
  }
  for (Seen& point : points) {
    std::sort(point.poses.begin(), point.poses.end());
    point.spread2 /= std::max<double>(1.0, static_cast<double>(point.poses.size()));
  }
  return points;
}

/// How many sightings there are from each pose.
std::vector<std::size_t> companyOf(const Drive& drive) {
  std::vector<std::size_t> company(drive.T_world_robot.size(), 0);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) ++company[sighting.pose];
  return company;
}

struct Pair {
  std::size_t point = 0, into = 0;
  double distance_m = 0.0;
};

/// Nearest first.
std::vector<Pair> nearPairs(const Drive& drive) {
  const auto seen = seenOf(drive);
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < seen.size(); ++a) {
    if (!drive.nameless[a] || seen[a].poses.empty()) continue;
    for (std::size_t b = 0; b < seen.size(); ++b) {
      const std::size_t count_a = seen[a].poses.size(), count_b = seen[b].poses.size();
      const bool is_rarer = count_a < count_b || (count_a == count_b && (a > b));
      if (a == b || !(is_rarer || !drive.nameless[b]) || count_b == 0) continue;
      const double distance_m = (drive.points_world[a] - drive.points_world[b]).norm();
      if (distance_m < kNear * std::sqrt(seen[a].spread2)) pairs.push_back({a, b, distance_m});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& x, const Pair& y) { return x.distance_m < y.distance_m; });
  return pairs;
}

/// Whether two points keep out of each other's way, as one thing with two names does.
bool excludeEachOther(const Drive& drive, const Seen& point, const Seen& other) {
  const auto company = companyOf(drive);
  std::size_t together = 0, in_company = 0;
  for (const std::size_t pose : point.poses) {
    const bool both = std::binary_search(other.poses.begin(), other.poses.end(), pose);
    together += both;
    in_company += !both && company[pose] > 1;
  }
  return kHardlyEver * together <= std::min(point.poses.size(), other.poses.size()) &&
         in_company >= kFewestInCompany;
}

Drive withOnePoint(const Drive& drive, const Pair& pair) {
  Drive one = drive;
  for (Drive::Sighting& sighting : one.sightings)
    if (sighting.point == pair.point) sighting.point = pair.into;
  return one;
}

}  // namespace

void mergeDuplicates(Drive& drive, double gate_probability, Smoothing& result) {
  if (drive.nameless.empty()) return;
  std::size_t trials = affordableTrials(drive);
  for (const Pair& pair : nearPairs(drive)) {
    const auto seen = seenOf(drive);  // by now
    const Seen &point = seen[pair.point], &into = seen[pair.into];
    if (point.poses.empty() || into.poses.empty() || !excludeEachOther(drive, point, into))
      continue;
    if (trials-- == 0) return;
    Drive one = withOnePoint(drive, pair);
    Smoothing how = result;
    settle(one, gate_probability, how);
    result.steps = how.steps;
    if (!(how.cost <= result.cost + costOfUnused(2, gate_probability) + point.numbers)) continue;
    drive = std::move(one);
    result = std::move(how);
    result.merged.push_back({pair.point, pair.into});
  }
}

}  // namespace colonnade
