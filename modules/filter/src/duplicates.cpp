// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "duplicates.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "settle.hpp"

namespace colonnade {
namespace {

constexpr double kNear = 10.0;  ///< deviations of a reading
/// Hardly ever together: in one of so many sightings of the rarer one.
constexpr double kHardlyEver = 10.0;
/// Two that are two are seen together so seldom by chance at most this often. Not stricter: two
/// things so near that their readings suit one place are rare, landmarks founded twice are not.
constexpr double kChance = 0.2;
/// Share of the readings within the range, and the angle, a sensor is taken to see.
constexpr double kMostReadings = 0.95;

/// What the sightings in use say of one point.
struct Seen {
  std::vector<std::size_t> poses;  ///< ascending; one for each sighting
  double numbers = 0.0;            ///< that were measured
  double spread2 = 0.0;            ///< m^2, the mean of its readings
};

double quantile(std::vector<double> values) {
  const auto at =
      static_cast<std::ptrdiff_t>(kMostReadings * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Who is seen with whom.
class Company {
 public:
  explicit Company(const Drive& drive)
      : drive_(drive), points_(drive.points_world.size()), poses_(drive.T_world_robot.size()) {
    std::vector<double> ranges, angles;
    for (const Drive::Sighting& sighting : drive.sightings) {
      const Measurement& m = sighting.measurement;
      if (!sighting.used || !m.hasRange()) continue;
      Seen& point = points_[sighting.point];
      point.poses.push_back(sighting.pose);
      point.numbers += static_cast<double>(m.z.size());
      point.spread2 += m.R(1, 1) + m.z(1) * m.z(1) * m.R(0, 0);
      ++poses_[sighting.pose].sightings;
      poses_[sighting.pose].p_robot_camera = m.p_robot_camera;
      ranges.push_back(m.z(1));
      angles.push_back(std::abs(m.z(0)));
    }
    for (Seen& point : points_) {
      std::sort(point.poses.begin(), point.poses.end());
      point.spread2 /= std::max<double>(1.0, static_cast<double>(point.poses.size()));
    }
    if (ranges.empty()) return;
    range_m_ = quantile(std::move(ranges));
    angle_ = quantile(std::move(angles));
  }

  const Seen& operator[](std::size_t point) const { return points_[point]; }

  /// Whether two points keep out of each other's way, as one thing with two names does. Were they
  /// two, of what is in view with the rarer one the other would be as likely as any to be among
  /// what is seen, and how often it is would follow Poisson's law.
  bool excludeEachOther(std::size_t a, std::size_t b) {
    const bool a_is_rarer = points_[a].poses.size() <= points_[b].poses.size();
    const Seen &rarer = points_[a_is_rarer ? a : b], &other = points_[a_is_rarer ? b : a];
    double together = 0.0, expected = 0.0;
    for (const std::size_t pose : rarer.poses)
      if (std::binary_search(other.poses.begin(), other.poses.end(), pose)) together += 1.0;
    if (kHardlyEver * together > static_cast<double>(rarer.poses.size())) return false;
    for (const std::size_t pose : rarer.poses) {
      if (poses_[pose].sightings < 2) continue;
      const auto others = static_cast<double>(poses_[pose].sightings - 1);
      expected += others / std::max(others, inView(pose) - 1.0);
    }
    return expected > 0.0 && boost::math::gamma_q(together + 1.0, expected) <= kChance;
  }

 private:
  struct Pose {
    std::size_t sightings = 0;
    Eigen::Vector2d p_robot_camera = Eigen::Vector2d::Zero();
    std::optional<double> in_view;  ///< once it was asked for
  };

  /// How many points a sensor like this one may see from there.
  double inView(std::size_t pose) {
    auto& [sightings, p_robot_camera, in_view] = poses_[pose];
    if (in_view) return *in_view;
    in_view = 0.0;
    const Pose2 T_robot_world = drive_.T_world_robot[pose].inverse();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (points_[i].poses.empty()) continue;
      const Eigen::Vector2d p = transform(T_robot_world, drive_.points_world[i]) - p_robot_camera;
      if (p.squaredNorm() <= range_m_ * range_m_ && std::abs(std::atan2(p.y(), p.x())) <= angle_)
        *in_view += 1.0;
    }
    return *in_view;
  }

  const Drive& drive_;
  std::vector<Seen> points_;
  std::vector<Pose> poses_;
  double range_m_ = 0.0, angle_ = 0.0;
};

struct Pair {
  std::size_t point = 0, into = 0;
  double distance_m = 0.0;
};

bool isKnown(const Drive& drive, std::size_t point) {
  return drive.prior && point < drive.prior->points_world.size();
}

/// Nearest first. Of two without a name the one known beforehand stays, or else the rarer one is
/// merged into the other.
std::vector<Pair> nearPairs(const Drive& drive, const Company& seen) {
  const auto goesFirst = [&](std::size_t a, std::size_t b) {
    if (!drive.nameless[b]) return true;
    if (isKnown(drive, a) != isKnown(drive, b)) return isKnown(drive, b);
    const std::size_t count_a = seen[a].poses.size(), count_b = seen[b].poses.size();
    return count_a < count_b || (count_a == count_b && a > b);
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < drive.points_world.size(); ++a) {
    if (!drive.nameless[a] || seen[a].poses.empty()) continue;
    for (std::size_t b = 0; b < drive.points_world.size(); ++b) {
      if (a == b || seen[b].poses.empty() || !goesFirst(a, b)) continue;
      if (isKnown(drive, a) && !isKnown(drive, b)) continue;  // what is known of it would be lost
      const double distance_m = (drive.points_world[a] - drive.points_world[b]).norm();
      if (distance_m < kNear * std::sqrt(seen[a].spread2)) pairs.push_back({a, b, distance_m});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& x, const Pair& y) { return x.distance_m < y.distance_m; });
  return pairs;
}

Drive withOnePoint(const Drive& drive, const Pair& pair) {
  Drive one = drive;
  for (Drive::Sighting& sighting : one.sightings)
    if (sighting.point == pair.point) sighting.point = pair.into;
  if (isKnown(drive, pair.point)) one.one.push_back({pair.point, pair.into});
  return one;
}

}  // namespace

void mergeDuplicates(Drive& drive, double gate_probability, Smoothing& result) {
  if (drive.nameless.empty()) return;
  const int most_steps = result.steps + affordableSteps(drive);
  std::set<std::pair<std::size_t, std::size_t>> tried;
  for (bool merged = true; merged;) {
    merged = false;
    Company seen(drive);
    for (const Pair& pair : nearPairs(drive, seen)) {
      if (tried.contains(std::minmax(pair.point, pair.into)) ||
          !seen.excludeEachOther(pair.point, pair.into))
        continue;
      if (result.steps >= most_steps) return;
      tried.insert(std::minmax(pair.point, pair.into));
      Drive one = withOnePoint(drive, pair);
      Smoothing how = result;
      settle(one, gate_probability, how);
      result.steps = how.steps;
      const double allowed = costOfUnused(2, gate_probability) +
                             std::min(seen[pair.point].numbers, seen[pair.into].numbers);
      if (!how.converged || !(how.cost <= result.cost + allowed)) continue;
      drive = std::move(one);
      result = std::move(how);
      result.merged.push_back({pair.point, pair.into});
      merged = true;
      break;  // who is near whom, and which is the rarer one, is no longer what it was
    }
  }
}

}  // namespace colonnade
