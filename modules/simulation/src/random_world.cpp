// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/random_world.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/simulation/world_check.hpp"
#include "random_plan.hpp"

namespace colonnade {
namespace {

constexpr int kAttempts = 50;
constexpr double kWallM = 0.20;       ///< between a corridor and a room
constexpr double kFromCornerM = 0.7;  ///< of the first and last thing on a wall
constexpr double kForArcsM = 1.3;     ///< along a leg, for the arcs into a room and out of it
constexpr double kIntoRoomM = 1.5;    ///< how far the robot drives in
constexpr int kMostVisits = 2;        ///< one where the way is long

std::string text(double value) { return formatFixed(value + 0.0, 2); }
std::string text(const Eigen::Vector2d& p) { return text(p.x()) + " " + text(p.y()); }

/// A way into a room and back.
struct Visit {
  double along_m;  ///< of its leg
  Eigen::Vector2d front, inside;
};

class Writer {
 public:
  Writer(std::uint64_t seed, int attempt, const RandomWorldOptions& options)
      : options_(options),
        random_(seed, "building " + std::to_string(attempt)),
        plan_(drawPlan(random_, options)),
        visits_(plan_.legs.size()) {
    out_ = "# A random building: seed " + std::to_string(seed) +
           ". The format is described in modules/simulation/README.md.\n\n";
  }

  std::string write() {
    materials();
    walls();
    for (const auto& wall : plan_.walls) furnish(wall);
    hall();
    lamps();
    if (options_.people && random_.uniform() < 0.5) person();
    robot();
    return out_;
  }

 private:
  double pick(double low, double high) { return between(random_, low, high); }
  bool chance(double share) { return random_.uniform() < share; }
  void line(const std::string& statement) { out_ += statement + "\n"; }

  std::string colour(double low, double high, double tint) {
    const double level = pick(low, high);
    std::string result;
    for (int i = 0; i < 3; ++i) {
      const double value = std::clamp(level + pick(-tint, tint), 0.0, 255.0);
      result += (i ? "," : "") + formatFixed(value, 0);
    }
    return result;
  }

  void materials() {
    line("material plaster pattern=plaster colour=" + colour(185, 220, 8) + " grain=3 blotches=5");
    const std::string accent = chance(0.5) ? "plaster" : chance(0.5) ? "decals" : "sheets";
    line("material accent  pattern=" + accent + " tile_m=1.2 colour=" + colour(120, 180, 35) +
         " grain=3 blotches=4");
    line("material door1   pattern=panels  colour=" + colour(90, 150, 35) + " second=70,60,54");
    line("material door2   pattern=panels  colour=" + colour(90, 160, 35) + " second=64,66,70");
    line("material stone   pattern=plaster colour=" + colour(110, 170, 6) + " grain=5 blotches=7");
    line("material dark    pattern=plaster colour=" + colour(35, 75, 8) + " grain=3 blotches=3");
    const std::string tile = text(pick(0.3, 0.6));
    const std::string gloss = chance(0.3) ? " gloss=" + text(pick(0.05, 0.15)) : "";
    line("material ground  pattern=tiles   colour=" + colour(115, 160, 10) +
         " second=100,96,90 tile_m=" + tile + gloss);
    line("material baseboard pattern=plain colour=" + colour(50, 100, 6));
    line("floor material=ground\n");
    skirting_ = " skirting=baseboard skirting_m=" + text(pick(0.07, 0.12));
    if (chance(0.5)) skirting_ += " skirting_out_m=" + text(pick(0.01, 0.03));
  }

  void walls() {
    line("# Free space is on the left of every wall.");
    for (const auto& wall : plan_.walls) {
      line("wall " + wall.name + " " + text(wall.a) + " " + text(wall.b) +
           (wall.leg >= 0 ? " hallway=" + std::to_string(wall.leg) : "") + skirting_ +
           (chance(0.25) ? " material=accent" : ""));
    }
  }

  /// Things along a wall, one after the other.
  void furnish(const PlanWall& wall) {
    line("");
    double s = kFromCornerM + pick(0.0, 0.8);
    for (;;) {
      const double what = random_.uniform();
      const bool wide = wall.leg >= 0 && plan_.legs[index(wall)].half_m >= 1.15;
      const double width = what < 0.45   ? pick(0.85, 1.0)
                           : what < 0.75 ? pick(0.25, 0.45)
                                         : pick(0.8, 1.4);
      const double taken = what < 0.45 ? width + 0.16 : width;
      if (s + taken > wall.length() - kFromCornerM) return;
      const double at = std::round(100.0 * (s + 0.5 * taken)) / 100.0;
      if (what < 0.45) {
        door(wall, at, width);
      } else if (what < 0.75) {
        line("pilaster wall=" + wall.name + " at_m=" + text(at) + " width_m=" + text(width) +
             " depth_m=" + text(pick(0.10, 0.25)) + " material=stone");
      } else if (what < 0.9 || !wide) {
        line("board wall=" + wall.name + " at_m=" + text(at) + " width_m=" + text(width));
      } else {
        line("cabinet " + text(wall.at(at, 0.25)) + " size_m=" + text(width) +
             ",0.40 turn_deg=" + turnOf(wall.along()) + " material=door2");
      }
      s += taken + pick(0.35, 1.6);
    }
  }

  std::size_t index(const PlanWall& wall) const { return static_cast<std::size_t>(wall.leg); }

  static std::string turnOf(const Eigen::Vector2d& along) {
    return formatFixed(std::round(degrees(std::atan2(along.y(), along.x()))) + 0.0, 0);
  }

  void door(const PlanWall& wall, double at, double width) {
    std::string statement = "door wall=" + wall.name + " at_m=" + text(at) +
                            " width_m=" + text(width) +
                            (chance(0.5) ? " material=door1" : " material=door2");
    if (options_.rooms && wall.leg >= 0 && chance(0.6) && room(wall, at, statement)) return;
    if (chance(0.3)) statement += " recess_m=0.2 frame_m=0";
    line(statement);
  }

  /// A room behind a door, when there is space for one; finishes the door's statement.
  bool room(const PlanWall& wall, double at, std::string statement) {
    const double before = pick(1.3, 2.4), after = pick(1.3, 2.4), deep = pick(3.3, 4.2);
    const double near = -kWallM, far = -kWallM - deep;
    const Area area = Area::around(wall.at(at - before, near), wall.at(at + after, far), 0.15);
    for (const auto& other : plan_.taken) {
      if (area.overlaps(other)) return false;
    }
    plan_.taken.push_back(area);
    const std::string name = "room" + std::to_string(++rooms_);
    line("room " + name + " " + text(wall.at(at + after, near)) + " " +
         text(wall.at(at - before, near)) + " " + text(wall.at(at - before, far)) + " " +
         text(wall.at(at + after, far)) + skirting_ + (chance(0.3) ? " material=accent" : ""));
    const bool open = chance(0.7);
    statement += " into=" + name + ".1";
    if (open) {
      statement += chance(0.5) ? " state=open hinge=left" : " state=open hinge=right";
      statement += " open_deg=" + formatFixed(pick(85, 105), 0);
    } else {
      statement += " material=glass";
      statement.replace(statement.find(" material=door"), 15, "");
    }
    line(statement);
    const std::string turn = " turn_deg=" + turnOf(wall.along());
    line("table " + text(wall.at(at - 0.2, far + 0.45)) + " size_m=1.40,0.70" + turn);
    line("chair " + text(wall.at(at + pick(-0.4, 0.4), far + 1.05)) +
         " turn_deg=" + turnOf(-wall.out()));
    if (chance(0.6)) {
      line("cabinet " + text(wall.at(at + after - 0.25, far + pick(0.8, 1.6))) +
           " size_m=0.40,0.90" + turn + " material=door1");
    }
    line("board wall=" + name + ".3 at_m=" + text(0.5 * (before + after)) + " width_m=1.2");
    line("lamp " + text(wall.at(at, -kWallM - 0.5 * deep)) + " size_m=0.6,0.6");
    if (open) planVisit(wall, at);
    return true;
  }

  void planVisit(const PlanWall& wall, double at) {
    const Leg& leg = plan_.legs[index(wall)];
    auto& visits = visits_[index(wall)];
    const Eigen::Vector2d front = wall.at(at, leg.half_m);
    const double along = (front - leg.from).dot(leg.along());
    const int most = plan_.legs.size() > 3 ? 1 : kMostVisits;
    bool fits = visit_count_ < most && !leg.hall && along > kForArcsM + 0.4 &&
                along < leg.length() - kForArcsM - 0.4;
    if (plan_.ring && wall.leg == 0) fits = fits && front.x() > kForArcsM;
    for (const auto& other : visits) fits = fits && std::abs(other.along_m - along) > kForArcsM;
    if (!fits) return;
    visits.push_back({along, front, wall.at(at, -kWallM - kIntoRoomM)});
    ++visit_count_;
  }

  /// Pillars on both sides of the way through a hall.
  void hall() {
    const Leg& leg = plan_.legs.back();
    if (!leg.hall) return;
    line("");
    const double first = plan_.legs[plan_.legs.size() - 2].half_m + 1.2;
    for (double s = first; s < leg.length() + 0.4; s += pick(2.2, 3.0)) {
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d p =
            leg.from + s * leg.along() + side * pick(1.1, leg.half_m - 0.9) * leg.left();
        const std::string material = chance(0.5) ? " material=dark" : " material=stone";
        const std::string width = text(pick(0.3, 0.5)), depth = text(pick(0.3, 0.5));
        line(chance(0.4) ? "column " + text(p) + " diameter_m=" + width + material
                         : "pillar " + text(p) + " size_m=" + width + "," + depth + material);
      }
    }
  }

  void lamps() {
    line("");
    for (const auto& leg : plan_.legs) {
      for (double s = 0.5; s < leg.length(); s += pick(2.4, 3.4)) {
        const double reach = leg.hall ? 0.5 * leg.half_m : 0.0;
        for (const double side : {-1.0, 1.0}) {
          if (side < 0.0 && !leg.hall) continue;
          line("lamp " + text(leg.from + s * leg.along() + side * reach * leg.left()) +
               (std::abs(leg.along().x()) > 0.5 ? " size_m=1.2,0.3" : " size_m=0.3,1.2"));
        }
      }
    }
  }

  /// Someone who walks up and down along a wall of one leg.
  void person() {
    const auto& leg = plan_.legs[static_cast<std::size_t>(random_.uniform() *
                                                          static_cast<double>(plan_.legs.size()))];
    const Eigen::Vector2d aside = (chance(0.5) ? 1.0 : -1.0) * (leg.half_m - 0.36) * leg.left();
    const std::string speed = text(pick(0.7, 1.4)), phase = text(pick(0.0, 10.0));
    line("walker " + text(leg.to + aside) + " " + text(leg.from + aside) +
         " speed_m_per_s=" + speed + " phase_s=" + phase + " clothes=" + colour(40, 200, 50));
  }

  void robot() {
    line(
        "\ncamera width_px=320 height_px=240 field_of_view_deg=58 height_m=0.90 pitch_deg=12 "
        "rate_hz=10");
    line("odometry scale=0.025 turn_bias_deg_per_m=0.7 turn_noise_deg_per_m=0.4\n");
    line("start 0 0 heading_deg=0");
    line("wait 0.3");
    const std::string speed = " speed_m_per_s=" + text(pick(0.8, 1.0));
    for (std::size_t i = 0; i < plan_.legs.size(); ++i) {
      auto& visits = visits_[i];
      std::sort(visits.begin(), visits.end(),
                [](const Visit& a, const Visit& b) { return a.along_m < b.along_m; });
      for (const auto& visit : visits) {
        line("drive " + text(visit.front) + speed + " radius_m=0.5");
        line("drive " + text(visit.inside) + " speed_m_per_s=0.7");
        line(std::string("turn ") + (chance(0.5) ? "180" : "-180") + " rate_deg_per_s=40");
        line("drive " + text(visit.front) + " speed_m_per_s=0.7 radius_m=0.5");
      }
      line("drive " + text(plan_.legs[i].to) + speed + " radius_m=0.8");
    }
    if (plan_.ring) line("drive 2.50 0.00" + speed);
  }

  RandomWorldOptions options_;
  Random random_;
  RandomPlan plan_;
  std::vector<std::vector<Visit>> visits_;  ///< per leg
  int visit_count_ = 0;
  int rooms_ = 0;
  std::string skirting_;
  std::string out_;
};

}  // namespace

std::string randomWorldText(std::uint64_t seed, const RandomWorldOptions& options) {
  std::string reason;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string world = Writer(seed, attempt, options).write();
    try {
      checkWorld(parseWorld(world, "random:" + std::to_string(seed)));
      return world;
    } catch (const Error& error) {
      reason = error.what();
    }
  }
  throw Error("random world: no building found; last: " + reason);
}

}  // namespace colonnade
