// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "colonnade/base/error.hpp"
#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/drive.hpp"
#include "colonnade/simulation/world_check.hpp"
#include "shared_data.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The message of the error this text causes.
std::string errorOf(const std::string& text) {
  try {
    checkWorld(parseWorld(text, "my.world"));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "no error";
}

/// A closed room of 5 m by 4 m, one wall a line, and a way through its middle.
std::string closedRoom(const std::string& more) {
  return "wall south 0 0 5 0\nwall east 5 0 5 4\nwall north 5 4 0 4\nwall west 0 4 0 0\n"
         "start 1 2\n" +
         more;
}

const std::string kWall = "wall south 0 0 5 0\n";

TEST(World, readsWhatTheFileSays) {
  const auto world = parseWorld(
      "# a comment\n\nwall south 0 0 5 0 height_m=3 hallway=4 # another\n"
      "door wall=south at_m=2.5 width_m=1.0 recess_m=0.2\n"
      "camera width_px=640 height_px=480 pitch_deg=30\n"
      "start 1 2 heading_deg=90\ndrive 1 5 speed_m_per_s=0.4\nturn -90\nwait 2\n",
      "my.world");
  EXPECT_EQ(world.name, "my");
  ASSERT_EQ(world.walls.size(), 1U);
  EXPECT_DOUBLE_EQ(world.walls[0].height_m, 3.0);
  EXPECT_EQ(world.walls[0].hallway, 4);
  ASSERT_EQ(world.doors.size(), 1U);
  EXPECT_DOUBLE_EQ(world.doors[0].recess_m, 0.2);
  EXPECT_EQ(world.camera.width_px, 640);
  EXPECT_NEAR(world.camera.pitch, radians(30.0), 1e-12);
  EXPECT_NEAR(world.route.start.phi, radians(90.0), 1e-12);
  ASSERT_EQ(world.route.steps.size(), 3U);
  EXPECT_NEAR(world.route.steps[1].angle, radians(-90.0), 1e-12);
}

TEST(World, errorsNameFileLineAndWhatToDo) {
  EXPECT_THAT(errorOf(kWall + "wal x 0 0 1 1\n"),
              AllOf(HasSubstr("my.world:2:"), HasSubstr("'wal'"), HasSubstr("wall")));
  EXPECT_THAT(errorOf("\n" + kWall + "door wall=south at_m=2 widht_m=1\n"),
              AllOf(HasSubstr("my.world:3:"), HasSubstr("widht_m"), HasSubstr("width_m")));
  EXPECT_THAT(errorOf("camera width_px=5000\n"),
              AllOf(HasSubstr("my.world:1:"), HasSubstr("5000"), HasSubstr("1920")));
  EXPECT_THAT(errorOf("camera pitch_deg=steep\n"),
              AllOf(HasSubstr("my.world:1:"), HasSubstr("steep")));
  EXPECT_THAT(errorOf("camera height_m=nan\n"), HasSubstr("my.world:1:"));
  EXPECT_THAT(errorOf("light level=1\n"), HasSubstr("needs at_m or at_s"));
  EXPECT_THAT(errorOf("light at_m=2\nlight at_m=1\n"), HasSubstr("must lie after"));
  EXPECT_THAT(errorOf("light at_m=2\nlight at_s=3\n"), HasSubstr("not both"));
  EXPECT_THAT(errorOf(kWall + "door wall=north at_m=2\n"), HasSubstr("my.world:2:"));
  EXPECT_THAT(errorOf(kWall + "door wall=south at_m=4.9\n"),
              AllOf(HasSubstr("my.world:2:"), HasSubstr("5.0")));
  EXPECT_THAT(errorOf("wall south 0 0 5\n"), AllOf(HasSubstr("my.world:1:"), HasSubstr("missing")));
  EXPECT_THAT(errorOf(kWall + kWall), AllOf(HasSubstr("my.world:2:"), HasSubstr("south")));
  EXPECT_THAT(errorOf(kWall + "pillar 1 1 material=gold\n"), HasSubstr("gold"));
  EXPECT_THAT(errorOf(kWall), HasSubstr("drive"));
  EXPECT_THAT(errorOf("drive 1 1\n"), HasSubstr("wall"));
  EXPECT_THAT(errorOf(kWall + "drive 1 1\ndoor wall=south at_m=2\npilaster wall=south at_m=2.4\n"),
              AllOf(HasSubstr("south"), HasSubstr("overlap")));
  EXPECT_THROW(readWorld("/nowhere.world"), Error);
}

TEST(World, anOpenWallIsRefusedWithItsLine) {
  EXPECT_EQ(errorOf(closedRoom("drive 4 2\n")), "no error");
  // The north wall is missing: both its neighbours end in the open.
  EXPECT_THAT(errorOf("wall south 0 0 5 0\nwall east 5 0 5 4\nwall west 0 4 0 0\n"
                      "start 1 2\ndrive 4 2\n"),
              AllOf(HasSubstr("my.world:2: wall east"), HasSubstr("5.00 4.00")));
  // A crack of 4 cm.
  EXPECT_THAT(errorOf("wall south 0 0 4.96 0\nwall east 5 0 5 4\nwall north 5 4 0 4\n"
                      "wall west 0 4 0 0\nstart 1 2\ndrive 4 2\n"),
              AllOf(HasSubstr("my.world:1: wall south"), HasSubstr("0.04 m from wall east")));
  // A partition within the room leaks nowhere.
  EXPECT_EQ(errorOf(closedRoom("wall partition 2.5 0 2.5 1\ndrive 4 2\n")), "no error");
  // Behind an open door the room must be closed as well, once the robot is there.
  const std::string open_room =
      "wall p 0 4.2 5 4.2\nwall q 5 4.2 5 8\nwall r 0 8 0 4.2\n"
      "door wall=north at_m=2.5 into=p state=open hinge=left\n";
  EXPECT_EQ(errorOf(closedRoom(open_room + "drive 2.5 2\n")), "no error");
  EXPECT_THAT(errorOf(closedRoom(open_room + "drive 2.5 2\ndrive 2.5 6\n")),
              HasSubstr("my.world:7: wall q"));
  EXPECT_THAT(errorOf("room r 0 0 5 0 5 4 0 4\nstart 9 9\ndrive 9 7\n"),
              AllOf(HasSubstr("my.world:2:"), HasSubstr("outside")));
}

TEST(World, aRobotThatRunsIntoSomethingIsRefusedWithTheLineOfItsStep) {
  for (const auto& [thing, name] :
       {std::pair{"", "wall east"},
        {"pillar 3.2 2 size_m=0.3,0.3\n", "the pillar of my.world:6"},
        {"column 3.2 2.2 diameter_m=0.4\n", "the pillar of my.world:6"},
        {"table 3.2 2\n", "the table of my.world:6"},
        {"chair 3.2 2\n", "the chair of my.world:6"},
        {"cabinet 3.2 2.4 turn_deg=90\n", "the cabinet of my.world:6"},
        {"pilaster wall=south at_m=3 width_m=0.4 depth_m=1.9\n", "wall south"}}) {
    SCOPED_TRACE(thing);
    const std::string text = closedRoom(thing) + "drive 2 2\ndrive 4.8 2\n";
    const int line = std::string(thing).empty() ? 7 : 8;
    EXPECT_THAT(errorOf(text), AllOf(HasSubstr("my.world:" + std::to_string(line) + ": the robot"),
                                     HasSubstr(name)));
  }
  EXPECT_THAT(errorOf(closedRoom("pillar 1 2\ndrive 3 2\n")), HasSubstr("my.world:5:"));
  // 0.3 m from the wall: too near for a larger robot.
  EXPECT_EQ(errorOf(closedRoom("drive 4.7 2\n")), "no error");
  EXPECT_THAT(errorOf(closedRoom("robot radius_m=0.4\ndrive 4.7 2\n")), HasSubstr("0.40 m"));
}

TEST(World, peopleNeedTwoPlacesAndKeepOffTheRobot) {
  EXPECT_THAT(errorOf(closedRoom("walker 1 1\ndrive 4 2\n")),
              AllOf(HasSubstr("my.world:6:"), HasSubstr("two waypoints")));
  EXPECT_THAT(errorOf(closedRoom("walker 3 1 3 1\ndrive 4 2\n")), HasSubstr("same place"));
  EXPECT_THAT(errorOf(closedRoom("walker 4 2 1 2\ndrive 4 2\n")),
              AllOf(HasSubstr("my.world:6:"), HasSubstr("into the robot")));
  EXPECT_EQ(errorOf(closedRoom("walker -3 1 9 1\ndrive 4 2\n")), "no error");
}

TEST(World, lengthsBelowZeroAreRefused) {
  for (const char* line :
       {"wall x 0 0 1 0 height_m=-2", "wall x 0 0 1 0 skirting_m=-0.1",
        "door wall=south at_m=2 width_m=-0.9", "door wall=south at_m=-2", "pillar 3 3 size_m=-1,1",
        "column 3 3 diameter_m=-0.2", "table 3 3 height_m=-0.7", "drive 3 2 speed_m_per_s=-1",
        "board wall=south at_m=2 width_m=-1", "walker 1 1 2 2 height_m=-1", "wait -1",
        "robot radius_m=-0.1"}) {
    EXPECT_THAT(errorOf(closedRoom(std::string(line) + "\ndrive 4 2\n")), HasSubstr("my.world:6: "))
        << line;
  }
}

TEST(World, doorsThatOverlapAreRefusedWithTheirLines) {
  EXPECT_THAT(errorOf(closedRoom("door wall=south at_m=2\ndoor wall=south at_m=2.8\ndrive 4 2\n")),
              AllOf(HasSubstr("my.world:6:"), HasSubstr("my.world:7"), HasSubstr("overlap")));
}

TEST(World, openDoorsNeedAWallBehindThatRunsTheOtherWay) {
  const std::string end = "drive 4 2\n";
  EXPECT_THAT(errorOf(closedRoom("door wall=south at_m=2 state=open\n" + end)),
              AllOf(HasSubstr("my.world:6:"), HasSubstr("into=WALL")));
  EXPECT_THAT(errorOf(closedRoom("door wall=south at_m=2 into=east state=open\n" + end)),
              HasSubstr("the other way"));
  EXPECT_THAT(errorOf(closedRoom("door wall=south at_m=2 state=ajar\n" + end)),
              HasSubstr("passage"));
}

TEST(World, partsOfTheRouteAreRepeated) {
  const std::string lap = "drive 4 2 radius_m=0\ndrive 1 2 radius_m=0\n";
  const auto steps = [&](const std::string& text, const std::vector<std::string>& more = {}) {
    return parseWorld(closedRoom(text), "my.world", more).route.steps.size();
  };
  EXPECT_EQ(steps("wait 1\nrepeat 3\n" + lap + "end\ndrive 3 2\n"), 8U);
  EXPECT_EQ(steps("repeat 3\n" + lap + "end\n", {"route laps=5"}), 10U);
  EXPECT_THAT(errorOf(closedRoom("repeat 3\n" + lap)), HasSubstr("my.world:6:"));
  EXPECT_THAT(errorOf(closedRoom(lap + "end\n")), HasSubstr("my.world:8:"));
  EXPECT_THAT(errorOf(closedRoom("repeat 0\n" + lap + "end\n")), HasSubstr("whole number"));
  EXPECT_THAT(errorOf(closedRoom("repeat 2\nrepeat 2\n" + lap + "end\nend\n")),
              HasSubstr("my.world:7:"));
}

TEST(World, walkersGoThereAndBackOrRound) {
  Walker walker;
  walker.waypoints = {{0, 0}, {4, 0}, {4, 3}};
  walker.speed_m_per_s = 1.0;
  EXPECT_NEAR(walker.poseAt(2.0).x, 2.0, 1e-9);
  EXPECT_NEAR(walker.poseAt(5.0).phi, radians(90.0), 1e-9);
  EXPECT_NEAR(walker.poseAt(8.0).y, 2.0, 1e-9);
  EXPECT_NEAR(walker.poseAt(8.0).phi, radians(-90.0), 1e-9);
  EXPECT_NEAR(walker.poseAt(15.0).x, 1.0, 1e-9);  // 14 m there and back
  walker.round = true;
  EXPECT_NEAR(walker.poseAt(9.5).x, 2.0, 1e-9);  // half of the 5 m back
  EXPECT_NEAR(walker.poseAt(9.5).y, 1.5, 1e-9);
  walker.phase_s = 2.0;
  EXPECT_NEAR(walker.poseAt(1.0).x, 3.0, 1e-9);
}

TEST(World, amendmentsComeLast) {
  const auto path = testing::sourceFolder() / "rawlogs/worlds/corridor.world";
  EXPECT_DOUBLE_EQ(readWorld(path, {"camera rate_hz=4"}).camera.rate_hz, 4.0);
  EXPECT_THROW(readWorld(path, {"camera speed=4"}), Error);
}

TEST(World, everyWorldInTheRepositoryCanBeBuiltAndDriven) {
  int worlds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::sourceFolder() / "rawlogs/worlds")) {
    if (entry.path().extension() != ".world") continue;
    SCOPED_TRACE(entry.path());
    const auto world = readWorld(entry.path());
    EXPECT_GT(buildBuilding(world).edges.size(), 10U);
    const auto poses = driveRoute(world.route, world.camera.rate_hz);
    const double duration_s = static_cast<double>(poses.size()) / world.camera.rate_hz;
    EXPECT_GT(duration_s, 20.0);
    EXPECT_LT(duration_s, 150.0);
    ++worlds;
  }
  EXPECT_GE(worlds, 1);
}

}  // namespace
}  // namespace colonnade
