// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/simulation/light_schedule.hpp"
#include "colonnade/simulation/sensor_options.hpp"

namespace colonnade {

/// How a surface is painted.
enum class Pattern { kPlaster, kTiles, kPanels, kPapers, kPlain, kLamp, kSheets, kDecals };

/// What light and the pattern of a depth sensor do at a surface. Glass is drawn see-through and,
/// like a mirror, gives no depth.
enum class Surface { kOpaque, kGlass, kMirror };

struct Material {
  std::string name;
  Pattern pattern = Pattern::kPlaster;
  Eigen::Vector3d colour = {200, 200, 200};  ///< red, green, blue of the lit surface, 0 to 255
  Eigen::Vector3d second = {120, 120, 120};  ///< joints of tiles, lines of panels
  double grain = 4.0;                        ///< gray levels of fine noise
  double blotches = 4.0;                     ///< gray levels of coarse noise
  double tile_m = 0.30;
  Surface surface = Surface::kOpaque;
  double gloss = 0.0;    ///< of a floor: share of light that it mirrors
  double opacity = 0.3;  ///< of glass: 0 nothing to see, 1 nothing to see behind
};

// Every thing in a world knows `where` it was written, as file:line, for errors.

/// A straight wall from a to b. Free space lies on its left. Metres.
struct Wall {
  std::string name;
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double height_m = 2.6;
  std::size_t material = 0;
  double skirting_m = 0.10;     ///< height of the skirting board, 0 = none
  double skirting_out_m = 0.0;  ///< how far it stands out, 0 = painted
  std::size_t skirting_material = 0;
  int hallway = -1;  ///< which hallway the wall belongs to, -1 = none
  std::string where = {};

  double length() const { return (b - a).norm(); }
};

/// The leaf of a door that stands open, seen from the wall of the door: it turns about one side of
/// the opening into what is behind.
struct OpenLeaf {
  double angle = radians(85.0);  ///< 0 = shut
  bool hinge_left = false;       ///< seen from this side of the wall
  double depth_m = 0.0;          ///< of the hinge behind the face of the wall
};

/// A door in a wall: an opening with a leaf set back by `recess_m` and a frame of `frame_m` width
/// around it that stands out by `protrusion_m`. `at_m` is the middle, from the wall's start.
/// A door that leads into the wall behind is two doors, one in either wall, each as deep as half
/// the distance of the walls.
struct Door {
  std::size_t wall = 0;
  double at_m = 0.0;
  double width_m = 0.9;
  double height_m = 2.05;
  double recess_m = 0.10;
  double frame_m = 0.08;
  double protrusion_m = 0.02;
  std::size_t material = 0;
  std::size_t frame_material = 0;
  bool through = false;  ///< no leaf in the opening: it leads to the other door behind
  std::optional<OpenLeaf> leaf = {};
  std::string where = {};
};

/// A half pillar that stands out of a wall over its whole height.
struct Pilaster {
  std::size_t wall = 0;
  double at_m = 0.0;
  double width_m = 0.4;
  double depth_m = 0.2;
  std::size_t material = 0;
  std::string where = {};
};

/// A free-standing pillar over the whole height.
struct Pillar {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = {0.4, 0.4};
  double turn = 0.0;
  double height_m = 2.6;
  std::size_t material = 0;
  bool round = false;  ///< of diameter size.x()
  std::string where = {};
};

/// A piece of furniture: a table or chair on four legs, a cabinet or bin that stands on the floor.
struct Furniture {
  enum class Kind { kTable, kChair, kCabinet, kBin } kind = Kind::kTable;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = {1.2, 0.7};
  double height_m = 0.74;
  double turn = 0.0;
  std::size_t material = 0;
  std::size_t leg_material = 0;
  std::string where = {};
};

/// A notice board on a wall. Its edges are vertical but end above the floor: no landmark.
struct Board {
  std::size_t wall = 0;
  double at_m = 0.0;
  double width_m = 1.2;
  double bottom_m = 1.0;
  double height_m = 0.9;
  double thickness_m = 0.02;
  std::size_t material = 0;
};

/// A person who walks along waypoints: from the last straight back to the first (`round`), else
/// there and back. Passes through walls; opaque, and not part of the map.
struct Walker {
  std::vector<Eigen::Vector2d> waypoints;  ///< two or more
  double speed_m_per_s = 1.2;
  double phase_s = 0.0;  ///< has been walking for so long when the robot starts
  bool round = false;
  double height_m = 1.75;
  Eigen::Vector3d clothes = {96, 70, 74};  ///< red, green, blue, 0 to 255
  Eigen::Vector3d trousers = {52, 56, 70};
  std::string where = {};

  double distanceAt(double time_s) const { return speed_m_per_s * (time_s + phase_s); }
  /// T_world_walker: x is forward, the origin on the floor. Time since the robot's start.
  Pose2 poseAt(double time_s) const;
};

struct Lamp {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = {1.2, 0.3};
  double brightness = 1.0;
};

/// One step of the robot's route.
struct RouteStep {
  enum class Kind { kDrive, kTurn, kWait } kind = Kind::kDrive;
  Eigen::Vector2d to = Eigen::Vector2d::Zero();  ///< drive: in the world
  double speed_m_per_s = 0.8;
  double radius_m = 0.7;  ///< drive: of the arc into the next leg, 0 = stop and turn on the spot
  double angle = 0.0;     ///< turn: counter-clockwise
  double turn_rate = radians(45.0);
  double duration_s = 0.0;  ///< wait
  std::string where = {};
};

struct Route {
  Pose2 start;
  std::vector<RouteStep> steps;  ///< repetitions written out
  double robot_radius_m = 0.25;  ///< the robot keeps so far from everything
  std::string where = {};        ///< of the start
};

/// A building, a robot in it and what its sensors do.
struct World {
  std::string name;
  std::vector<Material> materials;
  std::vector<Wall> walls;
  std::vector<Door> doors;
  std::vector<Pilaster> pilasters;
  std::vector<Pillar> pillars;
  std::vector<Furniture> furniture;
  std::vector<Board> boards;
  std::vector<Lamp> lamps;
  std::vector<Walker> walkers;
  std::size_t floor_material = 0;
  std::size_t ceiling_material = 0;
  double texels_per_m = 200.0;
  Route route;
  LightSchedule light;
  CameraOptions camera;
  MonoOptions mono;
  DepthOptions depth;
  ColourOptions colour;
  OdometryOptions odometry;
};

/// Reads a world and checks it (world_check.hpp); the format is described in
/// modules/simulation/README.md. Throws Error (kUsage) as "file:line: what is wrong, what would be
/// right". `amendments` are further statements, read after the file, such as "camera rate_hz=5".
World readWorld(const std::filesystem::path& path, const std::vector<std::string>& amendments = {});

/// The same from text, without the checks; `name` stands for the file in errors.
World parseWorld(std::string_view text, const std::string& name,
                 const std::vector<std::string>& amendments = {});

}  // namespace colonnade
