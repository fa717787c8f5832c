// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "random_plan.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kBehindStartM = 1.6;  ///< from the start to the wall behind the robot
constexpr double kBeyondEndM = 1.6;    ///< from the end of the route to the wall ahead
constexpr double kApartM = 0.6;        ///< between parts that do not belong together

double corridorHalf(Random& random) { return between(random, 0.90, 1.45); }

/// A path of legs at right angles, each with its own width.
std::vector<Leg> openPath(Random& random, const RandomWorldOptions& options) {
  const int most = std::clamp(options.most_legs, 1, 4);
  const int count = std::min(most, 2 + static_cast<int>(2.4 * random.uniform()));
  std::vector<Leg> legs;
  Eigen::Vector2d p(0, 0), along(1, 0);
  for (int i = 0; i < count; ++i) {
    Leg leg;
    leg.hall = options.halls && count > 1 && i + 1 == count && random.uniform() < 0.35;
    leg.half_m = leg.hall ? between(random, 2.6, 3.6) : corridorHalf(random);
    const double length = count == 1
                              ? between(random, 16.0, 20.0)
                              : between(random, count == 2 ? 9.0 : 7.0, count == 4 ? 8.0 : 11.0);
    leg.from = p;
    leg.to = p + length * along;
    p = leg.to;
    const double side = random.uniform() < 0.5 ? 1.0 : -1.0;
    along = Eigen::Vector2d(-side * along.y(), side * along.x());
    legs.push_back(leg);
  }
  return legs;
}

/// Around a courtyard, counter-clockwise; the robot starts on the first leg.
std::vector<Leg> ringPath(Random& random) {
  const double west = -between(random, 2.5, 4.0), east = between(random, 5.0, 8.0);
  const double north = between(random, 5.5, 8.0);
  const std::vector<Eigen::Vector2d> corners = {{west, 0}, {east, 0}, {east, north}, {west, north}};
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < 4; ++i) {
    legs.push_back({corners[i], corners[(i + 1) % 4], corridorHalf(random), false});
  }
  return legs;
}

/// The corner of two legs: that on their left (1) or right (-1).
Eigen::Vector2d corner(const Leg& before, const Leg& after, double side) {
  return before.to + side * (before.half_m * before.left() + after.half_m * after.left());
}

std::vector<PlanWall> wallsOf(const RandomPlan& plan) {
  const auto& legs = plan.legs;
  const std::size_t n = legs.size();
  const auto end = [&](std::size_t i, double side) -> Eigen::Vector2d {
    if (i + 1 < n || plan.ring) return corner(legs[i], legs[(i + 1) % n], side);
    return legs[i].to + kBeyondEndM * legs[i].along() + side * legs[i].half_m * legs[i].left();
  };
  const auto start = [&](std::size_t i, double side) -> Eigen::Vector2d {
    if (i > 0 || plan.ring) return end((i + n - 1) % n, side);
    return legs[i].from - kBehindStartM * legs[i].along() + side * legs[i].half_m * legs[i].left();
  };
  std::vector<PlanWall> walls;
  for (std::size_t i = 0; i < n; ++i) {
    walls.push_back(
        {"right" + std::to_string(i + 1), start(i, -1.0), end(i, -1.0), static_cast<int>(i)});
  }
  if (!plan.ring) walls.push_back({"end", end(n - 1, -1.0), end(n - 1, 1.0), -1});
  for (std::size_t i = n; i-- > 0;) {
    walls.push_back(
        {"left" + std::to_string(i + 1), end(i, 1.0), start(i, 1.0), static_cast<int>(i)});
  }
  if (!plan.ring) walls.push_back({"behind", start(0, 1.0), start(0, -1.0), -1});
  return walls;
}

/// What each leg covers, up to the outer walls of its neighbours.
std::vector<Area> areasOf(const RandomPlan& plan) {
  std::vector<Area> areas;
  const std::size_t n = plan.legs.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Leg& leg = plan.legs[i];
    const bool first = i == 0 && !plan.ring, last = i + 1 == n && !plan.ring;
    const double before = first ? kBehindStartM : plan.legs[(i + n - 1) % n].half_m;
    const double after = last ? kBeyondEndM : plan.legs[(i + 1) % n].half_m;
    areas.push_back(Area::around(leg.from - before * leg.along() + leg.half_m * leg.left(),
                                 leg.to + after * leg.along() - leg.half_m * leg.left(), 0.0));
  }
  return areas;
}

/// Do parts of the path that are no neighbours keep apart, and are all walls long enough?
bool sound(const RandomPlan& plan) {
  for (std::size_t i = 0; i < plan.taken.size(); ++i) {
    const Area grown = Area::around(plan.taken[i].low, plan.taken[i].high, kApartM);
    for (std::size_t j = i + 2; j < plan.taken.size(); ++j) {
      if (plan.ring && i == 0 && j + 1 == plan.taken.size()) continue;
      if (grown.overlaps(plan.taken[j])) return false;
    }
  }
  return std::all_of(plan.walls.begin(), plan.walls.end(),
                     [](const PlanWall& wall) { return wall.length() > 1.0; });
}

}  // namespace

double between(Random& random, double low, double high) {
  return std::round(100.0 * (low + (high - low) * random.uniform())) / 100.0;
}

RandomPlan drawPlan(Random& random, const RandomWorldOptions& options) {
  RandomPlan plan;
  do {
    plan.ring = options.rings && options.most_legs >= 4 && random.uniform() < 0.25;
    plan.legs = plan.ring ? ringPath(random) : openPath(random, options);
    plan.walls = wallsOf(plan);
    plan.taken = areasOf(plan);
  } while (!sound(plan));
  return plan;
}

}  // namespace colonnade
