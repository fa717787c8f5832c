// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "world_statements.hpp"

namespace colonnade {

void readStart(Statement& s, World& world) {
  const auto p = s.point(0, "the position");
  world.route.start = {p.x(), p.y(), 0.0};
  s.angle("heading_deg", world.route.start.phi, {-180, 180}, "");
  s.finish(2);
  world.route.where = s.where();
}

void readDrive(Statement& s, World& world) {
  RouteStep read;
  read.to = s.point(0, "the goal");
  s.number("speed_m_per_s", read.speed_m_per_s, {0.01, 10}, "");
  s.number("radius_m", read.radius_m, {0, 100}, "");
  s.finish(2);
  read.where = s.where();
  world.route.steps.push_back(read);
}

void readRobot(Statement& s, World& world) {
  s.number("radius_m", world.route.robot_radius_m, {0, 5}, "");
  s.finish(0);
}

void readTurn(Statement& s, World& world) {
  RouteStep read;
  read.kind = RouteStep::Kind::kTurn;
  read.angle = radians(s.numberWord(0, "the angle in degrees"));
  s.angle("rate_deg_per_s", read.turn_rate, {1, 720}, "");
  s.finish(1);
  read.where = s.where();
  world.route.steps.push_back(read);
}

void readWait(Statement& s, World& world) {
  RouteStep read;
  read.kind = RouteStep::Kind::kWait;
  read.duration_s = s.numberWord(0, "the seconds");
  if (read.duration_s < 0.0 || read.duration_s > 3600.0) s.fail("waits 0 to 3600 s");
  s.finish(1);
  read.where = s.where();
  world.route.steps.push_back(read);
}

void readCamera(Statement& s, World& world) {
  world.camera.visit(s);
  s.finish(0);
}

void readMono(Statement& s, World& world) {
  world.mono.enabled = true;
  world.mono.visit(s);
  s.finish(0);
}

void readLight(Statement& s, World& world) {
  auto& schedule = world.light;
  const bool by_time = s.has("at_s");
  if (by_time == s.has("at_m")) s.fail("needs at_m or at_s");
  LightSchedule::Point point;
  double level = 1.0;
  s.number(by_time ? "at_s" : "at_m", point.at, {0, 1e5}, "");
  s.number("level", level, {0, 10}, "");
  s.triple("tint", point.light, {0, 4});
  s.finish(0);
  point.light *= level;
  if (!schedule.points.empty()) {
    if (by_time != schedule.by_time) s.fail("use at_m or at_s in all light statements, not both");
    if (point.at <= schedule.points.back().at) s.fail("must lie after the light statement before");
  }
  schedule.by_time = by_time;
  schedule.points.push_back(point);
}

void readDepth(Statement& s, World& world) {
  world.depth.visit(s);
  s.finish(0);
}

void readColour(Statement& s, World& world) {
  world.colour.visit(s);
  s.finish(0);
}

void readOdometry(Statement& s, World& world) {
  world.odometry.visit(s);
  s.finish(0);
}

}  // namespace colonnade
