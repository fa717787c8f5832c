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
  if (world.camera.supersampling % 2 == 0) s.fail("supersampling must be odd");
  s.finish(0);
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
