// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/place_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "colonnade/simulation/world_file.hpp"
#include "colonnade/slam/mapper.hpp"
#include "plan_drive.hpp"

namespace colonnade {
namespace {

/// Posts of two kinds in a field, and a few of them as somebody else sees them.
class Field {
 public:
  explicit Field(unsigned seed) : random_(seed) {
    for (int i = 0; i < 120; ++i)
      map.push_back({{uniform(0.0, 25.0), uniform(0.0, 25.0)}, kindOf(i), i, nullptr});
  }
  /// Those within 5 m of a place, in a world of their own, without names.
  std::vector<PlaceMark> seenFrom(const Pose2& T_map_here) {
    std::vector<PlaceMark> here;
    for (const PlaceMark& mark : map) {
      PlaceMark seen = mark;
      seen.identity.reset();
      seen.p = transform(T_map_here.inverse(), mark.p) + Eigen::Vector2d(gauss(0.03), gauss(0.03));
      if (seen.p.norm() < 5.0) here.push_back(seen);
    }
    return here;
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

  std::vector<PlaceMark> map;

 private:
  static LandmarkKind kindOf(int i) {
    return i % 3 == 0 ? LandmarkKind::kDepthSlope : LandmarkKind::kPillarEdge;
  }
  std::mt19937 random_;
};

TEST(PlaceFinder, LaysAFewLandmarksOntoTheMap) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Field field(seed);
    const Pose2 T{field.uniform(7.0, 18.0), field.uniform(7.0, 18.0), field.uniform(-3.0, 3.0)};
    auto here = field.seenFrom(T);
    here.push_back({{1.0, 1.0}, LandmarkKind::kPillarEdge, {}, nullptr});  // was not there then
    const FoundPlace found = findPlace(field.map, here, {});
    ASSERT_EQ(found.refusal, "") << seed << ": " << found.fits << " of " << found.of;
    const Pose2 error = T.inverse() * found.T_map_here;
    EXPECT_LT(error.translation().norm(), 0.05) << seed;
    EXPECT_LT(std::abs(error.phi), radians(1.0)) << seed;
    for (const auto& [a, b] : found.pairs)
      EXPECT_LT((transform(T, here[a].p) - field.map[b].p).norm(), 0.15);
  }
}

TEST(PlaceFinder, RefusesWhatIsNotThereAndWhatIsThereTwice) {
  int found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Field field(seed), other(seed + 100);
    found += findPlace(field.map, other.seenFrom({12.0, 12.0, 1.0}), {}).refusal.empty() ? 1 : 0;
    auto twice = field.map;
    for (PlaceMark mark : field.map) {
      mark.p += Eigen::Vector2d(40.0, 3.0);
      twice.push_back(mark);
    }
    EXPECT_EQ(findPlace(twice, field.seenFrom({12.0, 12.0, 1.0}), {}).refusal,
              "another place fits as well");
  }
  EXPECT_EQ(found, 0);
}

TEST(PlaceFinder, NamesTellAtOnce) {
  Field field(3);
  const Pose2 T{12.0, 8.0, -2.0};
  std::vector<PlaceMark> here;
  for (const PlaceMark& mark : field.map) {
    if ((mark.p - T.translation()).norm() > 4.0 || here.size() == 3) continue;
    here.push_back(mark);
    here.back().p = transform(T.inverse(), mark.p);
  }
  const FoundPlace found = findPlace(field.map, here, {});
  EXPECT_EQ(found.refusal, "");
  EXPECT_LT((found.T_map_here.translation() - T.translation()).norm(), 1e-9);
  for (PlaceMark& mark : here) mark.identity.reset();
  EXPECT_EQ(findPlace(field.map, here, {}).refusal, "too few places fit");
}

TEST(PlaceFinder, FindsNothingInNothing) {
  EXPECT_FALSE(findPlace({}, {}, {}).refusal.empty());
  Field field(4);
  EXPECT_FALSE(findPlace(field.map, {}, {}).refusal.empty());
  EXPECT_FALSE(findPlace({}, field.map, {}).refusal.empty());
  const std::vector<PlaceMark> one(8, field.map.front());  // all in one place
  EXPECT_FALSE(findPlace(field.map, one, {}).refusal.empty());
}

World world(const std::string& name) {
  return loadWorld(COLONNADE_SOURCE "/rawlogs/worlds/" + name + ".world").world;
}

SavedMap mapOf(const std::string& name, std::uint64_t seed) {
  testing::PlanDrive plan(world(name), seed);
  Mapper mapper({});
  while (const auto seen = plan.next()) mapper.step(*seen);
  return mapper.savedMap();
}

struct Search {
  bool found = false;
  double way_m = 0.0;    ///< until then
  double first_m = 0.0;  ///< off the truth, at that moment
  double worst_m = 0.0;  ///< and from then on
  std::size_t landmarks = 0;
  std::size_t frames = 0, poses = 0;  ///< in the log, in the trajectory
};

/// A drive that begins so many frames later than the map's, and nobody knows where.
Search searchIn(const SavedMap& map, const std::string& name, std::uint64_t seed, int late,
                bool localize) {
  testing::PlanDrive plan(world(name), seed);
  for (int i = 0; i < late; ++i) plan.next();
  Resumption from;
  from.map = map;
  from.localize = localize;
  from.anywhere = PlaceOptions{};
  Mapper mapper({}, from);
  Search search;
  while (const auto seen = plan.next()) {
    mapper.step(*seen);
    ++search.frames;
    if (mapper.search()) {
      search.way_m += seen->motion.T_previous_robot.translation().norm();
      continue;
    }
    const double off_m = (mapper.filter().pose().translation() - plan.truth().translation()).norm();
    if (!search.found) search.first_m = off_m;
    search.found = true;
    search.worst_m = std::max(search.worst_m, off_m);
  }
  search.landmarks = mapper.map().size();
  search.poses = mapper.trajectory().size();
  return search;
}

TEST(PlaceSearch, ARobotAnywhereFindsWhereItIs) {
  for (const std::string name : {"ring", "office"}) {
    const SavedMap map = mapOf(name, 21);
    for (const int late : {0, 80}) {
      for (const bool localize : {true, false}) {
        const Search search = searchIn(map, name, 31, late, localize);
        ASSERT_TRUE(search.found) << name << late << localize;
        EXPECT_LT(search.way_m, 12.0) << name << late << localize;
        EXPECT_LT(search.first_m, 0.15) << name << late << localize;
        EXPECT_LT(search.worst_m, 0.2) << name << late << localize;
        EXPECT_LT(static_cast<double>(search.landmarks),
                  1.4 * static_cast<double>(map.state.blocks.size()));
        EXPECT_EQ(search.frames, search.poses) << name;  // those before were mapped again
      }
    }
  }
}

TEST(PlaceSearch, TheSymmetricCorridorIsNotTakenForItsOtherEnd) {
  const SavedMap map = mapOf("symmetric", 21);
  for (const int late : {0, 120, 200}) {
    const Search search = searchIn(map, "symmetric", 32, late, true);
    EXPECT_LT(search.worst_m, 0.3) << late;        // its ends are 14 m apart
    EXPECT_EQ(search.found, late == 200) << late;  // there it sees that one end is not mapped yet
  }
}

TEST(PlaceSearch, AnotherBuildingIsNoPlaceInTheMap) {
  const SavedMap map = mapOf("office", 21);
  for (const std::string name : {"ring", "two_hallways"}) {
    const Search search = searchIn(map, name, 31, 0, true);
    EXPECT_FALSE(search.found) << name;
    EXPECT_GT(search.landmarks, 20u) << name;  // it has a map of its own instead
  }
}

}  // namespace
}  // namespace colonnade
