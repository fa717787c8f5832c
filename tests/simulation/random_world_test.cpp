// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/random_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "colonnade/base/error.hpp"
#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/drive.hpp"
#include "colonnade/simulation/world_file.hpp"

namespace colonnade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kSeeds = 60;

TEST(RandomWorld, everySeedGivesABuildingThatPassesAllChecksAndDrives) {
  int rooms = 0, rings = 0, pillars = 0, people = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const auto world = loadWorld("random:" + std::to_string(seed)).world;
    const double duration_s = static_cast<double>(driveRoute(world.route, 10.0).size()) / 10.0;
    EXPECT_GT(duration_s, 15.0);
    EXPECT_LT(duration_s, 90.0);
    const auto building = buildBuilding(world);
    EXPECT_GT(building.edges.size(), 30U);
    EXPECT_LT(building.faces.size(), 2500U);  // rendering stays fast
    EXPECT_GE(world.lamps.size(), 4U);
    EXPECT_GE(world.doors.size() + world.pilasters.size() + world.boards.size(), 6U);
    rooms += !building.gaps.empty();
    rings += world.walls[4].name == "left4" && world.route.steps.back().to.y() == 0.0;
    pillars += !world.pillars.empty();
    people += !world.walkers.empty();
  }
  for (const int kind : {rooms, rings, pillars, people}) {
    EXPECT_GT(kind, kSeeds / 20);
    EXPECT_LE(kind, kSeeds);
  }
}

TEST(RandomWorld, theSameSeedGivesTheSameTextAndOthersDiffer) {
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 10; ++seed) texts.insert(randomWorldText(seed));
  EXPECT_EQ(texts.size(), 10U);
  EXPECT_EQ(texts.count(randomWorldText(3)), 1U);
}

TEST(RandomWorld, optionsLeaveThingsOut) {
  RandomWorldOptions plain;
  plain.most_legs = 1;
  plain.rooms = plain.people = plain.halls = plain.rings = false;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto text = randomWorldText(seed, plain);
    EXPECT_THAT(text, Not(HasSubstr("right2")));
    EXPECT_THAT(text, Not(HasSubstr("\nroom ")));
    EXPECT_THAT(text, Not(HasSubstr("\nwalker ")));
    EXPECT_THAT(text, Not(HasSubstr("\npillar ")));
  }
}

TEST(RandomWorld, aSeedThatIsNoNumberIsRefused) {
  for (const char* name : {"random:", "random:x", "random:-1", "random:1.5", "random:1e300"}) {
    try {
      loadWorld(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage);
      EXPECT_THAT(error.what(), HasSubstr("random:SEED"));
    }
  }
}

TEST(RandomWorld, theTextOfALoadedWorldRepeatsItsAmendments) {
  const auto loaded = loadWorld("random:5", {"camera rate_hz=4", "odometry scale=0"});
  EXPECT_DOUBLE_EQ(loaded.world.camera.rate_hz, 4.0);
  const auto again = parseWorld(loaded.text, "again.world");
  EXPECT_DOUBLE_EQ(again.camera.rate_hz, 4.0);
  EXPECT_DOUBLE_EQ(again.odometry.scale, 0.0);
}

}  // namespace
}  // namespace colonnade
