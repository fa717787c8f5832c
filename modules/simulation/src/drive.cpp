// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr double kAcceleration = 0.5;        ///< m/s^2
constexpr double kTurnRate = radians(60.0);  ///< fastest turn in an arc
constexpr double kStepsPerSecond = 1000.0;

/// A piece of constant curvature, or a turn on the spot, or a pause.
struct Piece {
  double length_m = 0.0;
  double curvature = 0.0;
  double speed = 0.0;
  double turn = 0.0;  ///< on the spot
  double turn_rate = 0.0;
  double wait_s = 0.0;
  std::size_t step = 0;  ///< of the route

  bool drives() const { return length_m > 0.0; }
};

[[noreturn]] void fail(const RouteStep& step, const std::string& what) {
  throw Error((step.where.empty() ? "route" : step.where) + ": drive " +
                  formatFixed(step.to.x(), 2) + " " + formatFixed(step.to.y(), 2) + ": " + what,
              ExitCode::kUsage);
}

/// Distance from the corner at which an arc of this radius begins, for a turn by `angle`.
double cutOf(double radius, double angle) { return radius * std::tan(0.5 * std::abs(angle)); }

std::vector<Piece> piecesOf(const Route& route) {
  std::vector<Piece> pieces;
  Eigen::Vector2d p = route.start.translation();
  double heading = route.start.phi;
  double used = 0.0;  // of the leg, by the arc at its beginning
  std::size_t current = 0;
  const auto add = [&](Piece piece) {
    piece.step = current;
    pieces.push_back(piece);
  };
  const auto turnOnTheSpot = [&](double angle, double rate) {
    if (std::abs(angle) > 1e-6) add({.turn = angle, .turn_rate = rate});
    heading += angle;
  };
  for (std::size_t i = 0; i < route.steps.size(); ++i) {
    const auto& step = route.steps[i];
    current = i;
    if (step.kind == RouteStep::Kind::kWait) {
      if (step.duration_s > 0.0) add({.wait_s = step.duration_s});
      continue;
    }
    if (step.kind == RouteStep::Kind::kTurn) {
      turnOnTheSpot(step.angle, step.turn_rate);
      continue;
    }
    const Eigen::Vector2d leg = step.to - p;
    if (leg.norm() < 1e-3) fail(step, "the robot is there already; leave it out");
    const double direction = std::atan2(leg.y(), leg.x());
    if (used == 0.0) turnOnTheSpot(wrapAngle(direction - heading), step.turn_rate);
    double cut = 0.0, angle = 0.0;
    const bool turns_into_next = i + 1 < route.steps.size() && step.radius_m > 0.0 &&
                                 route.steps[i + 1].kind == RouteStep::Kind::kDrive;
    if (turns_into_next) {
      const Eigen::Vector2d next = route.steps[i + 1].to - step.to;
      angle = wrapAngle(std::atan2(next.y(), next.x()) - direction);
      if (std::abs(angle) > radians(150.0))
        fail(step, "a turn of more than 150 degrees needs radius_m=0");
      cut = cutOf(step.radius_m, angle);
    }
    if (used + cut > leg.norm() + 1e-9)
      fail(step, "the arcs do not fit between its ends; use a smaller radius_m");
    add({.length_m = leg.norm() - used - cut, .speed = step.speed_m_per_s});
    if (std::abs(angle) > 1e-6) {
      add({.length_m = step.radius_m * std::abs(angle),
           .curvature = std::copysign(1.0 / step.radius_m, angle),
           .speed = std::min(step.speed_m_per_s, kTurnRate * step.radius_m)});
    }
    heading = direction + angle;
    used = cut;
    p = step.to;
  }
  return pieces;
}

/// Where constant curvature leads, exactly: arc of length s, else the straight line.
Pose2 advanced(const Pose2& pose, double s, double curvature) {
  const double turn = s * curvature;
  const double chord = std::abs(turn) < 1e-9 ? s : 2.0 * std::sin(0.5 * turn) / curvature;
  const double direction = pose.phi + 0.5 * turn;
  return {pose.x + chord * std::cos(direction), pose.y + chord * std::sin(direction),
          wrapAngle(pose.phi + turn)};
}

/// The fastest speed `remaining` metres before the end of piece `index` that still allows to brake
/// for everything that follows.
double allowedSpeed(const std::vector<Piece>& pieces, std::size_t index, double remaining) {
  double allowed = pieces[index].speed;
  double distance = remaining;
  for (std::size_t i = index + 1; i <= pieces.size(); ++i) {
    const double next = i < pieces.size() && pieces[i].drives() ? pieces[i].speed : 0.0;
    allowed = std::min(allowed, std::sqrt(next * next + 2.0 * kAcceleration * distance));
    if (next == 0.0 || distance > 10.0) break;
    distance += pieces[i].length_m;
  }
  return allowed;
}

/// Calls tick(pose, step of the route) after every dt seconds of the route; the start itself is not
/// told.
template <typename Tick>
void follow(const Route& route, double dt, const Tick& tick) {
  const auto pieces = piecesOf(route);
  Pose2 pose = route.start;  // at the beginning of the piece
  double speed = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    double done = 0.0;
    if (piece.drives()) {
      while (done < piece.length_m) {
        speed =
            std::min(speed + kAcceleration * dt, allowedSpeed(pieces, i, piece.length_m - done));
        done = std::min(piece.length_m, done + std::max(speed, 0.005) * dt);
        tick(advanced(pose, done, piece.curvature), piece.step);
      }
      pose = advanced(pose, piece.length_m, piece.curvature);
    } else if (piece.wait_s > 0.0) {
      for (; done < piece.wait_s; done += dt) tick(pose, piece.step);
    } else {
      while (done < std::abs(piece.turn)) {
        done = std::min(std::abs(piece.turn), done + piece.turn_rate * dt);
        tick({pose.x, pose.y, wrapAngle(pose.phi + std::copysign(done, piece.turn))}, piece.step);
      }
      pose.phi = wrapAngle(pose.phi + piece.turn);
    }
  }
}

Pose2 interpolated(const Pose2& a, const Pose2& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          wrapAngle(a.phi + share * wrapAngle(b.phi - a.phi))};
}

}  // namespace

std::vector<RoutePose> driveSteps(const Route& route, double rate_hz) {
  const int ticks_per_frame = std::max(1, static_cast<int>(std::lround(kStepsPerSecond / rate_hz)));
  std::vector<RoutePose> poses = {{route.start, 0}};
  int tick = 0;
  follow(route, 1.0 / (rate_hz * ticks_per_frame), [&](const Pose2& pose, std::size_t step) {
    if (++tick % ticks_per_frame == 0) poses.push_back({pose, step});
  });
  return poses;
}

double driveDuration(const Route& route) {
  std::int64_t steps = 0;
  follow(route, 1.0 / kStepsPerSecond, [&](const Pose2&, std::size_t) { ++steps; });
  return static_cast<double>(steps) / kStepsPerSecond;
}

std::vector<Pose2> posesAt(const Route& route, const std::vector<double>& times_s) {
  std::vector<Pose2> poses;
  poses.reserve(times_s.size());
  Pose2 before = route.start;
  std::int64_t ticks = 0;
  follow(route, 1.0 / kStepsPerSecond, [&](const Pose2& now, std::size_t) {
    const auto begin = static_cast<double>(ticks++);  // in ticks, as is what follows
    while (poses.size() < times_s.size() && times_s[poses.size()] * kStepsPerSecond < begin + 1.0) {
      const double share = times_s[poses.size()] * kStepsPerSecond - begin;
      poses.push_back(interpolated(before, now, std::max(0.0, share)));
    }
    before = now;
  });
  poses.resize(times_s.size(), before);
  return poses;
}

std::vector<Pose2> driveRoute(const Route& route, double rate_hz) {
  std::vector<Pose2> poses;
  for (const auto& at : driveSteps(route, rate_hz)) poses.push_back(at.pose);
  return poses;
}

}  // namespace colonnade
