// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "colonnade/base/error.hpp"
#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/drive.hpp"
#include "shared_data.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The message of the error this text causes.
std::string errorOf(const std::string& text) {
  try {
    buildBuilding(parseWorld(text, "my.world"));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "no error";
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
  EXPECT_THAT(errorOf("camera supersampling=2\n"), HasSubstr("odd"));
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
    EXPECT_GT(driveRoute(world.route, world.camera.rate_hz).size(), 50U);
    ++worlds;
  }
  EXPECT_GE(worlds, 1);
}

}  // namespace
}  // namespace colonnade
