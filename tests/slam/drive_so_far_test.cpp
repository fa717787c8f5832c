// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "arena_of_posts.hpp"
#include "colonnade/base/rigid_fit.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/slam/range_bearing_session.hpp"
#include "ring_of_posts.hpp"

namespace colonnade {
namespace {

using testing::ArenaOfPosts;
using testing::RingOfPosts;

struct Moments {
  double ate_m = 0.0;
  double nees = 0.0;
};

/// Of the poses said at their moment, mean over some drives.
Moments momentsOf(const RangeBearingOptions& options) {
  constexpr unsigned kDrives = 12;
  Moments mean;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    ArenaOfPosts source(seed);
    RangeBearingSession session(options, {}, {});
    std::vector<StampedCovariance> covariances;
    session.run(source, [&](const Frame& frame, const StepReport&, const auto& so_far) {
      covariances.push_back({frame.stamp_s, so_far.now().covariance, so_far.now().T_world_origin});
      return true;
    });
    const auto score = evaluateTrajectory(session.trajectory(), source.truth, {}, covariances);
    mean.ate_m += score.ate_rmse_m / kDrives;
    mean.nees += score.nees_mean.value_or(HUGE_VAL) / kDrives;
  }
  return mean;
}

/// A filter that takes derivatives at its first guesses of places is too sure of them.
TEST(DriveSoFar, IsTrueAndHonestWithBearingsAlone) {
  RangeBearingOptions options;
  options.bearing_only = true;
  const Moments smoothed = momentsOf(options);
  options.smooth_every = 0;
  const Moments filter = momentsOf(options);
  std::printf("bearings alone: smoothed so far ATE %.3f m NEES %.2f, filter %.3f m %.1f\n",
              smoothed.ate_m, smoothed.nees, filter.ate_m, filter.nees);
  EXPECT_LT(smoothed.ate_m, 0.75 * filter.ate_m);
  EXPECT_LT(smoothed.nees, 2.5);
  EXPECT_GT(smoothed.nees, 0.4);
}

TEST(DriveSoFar, IsNoWorseWithRanges) {
  RangeBearingOptions options;
  const Moments smoothed = momentsOf(options);
  options.smooth_every = 0;
  const Moments filter = momentsOf(options);
  std::printf("with ranges: smoothed so far ATE %.3f m NEES %.2f, filter %.3f m %.1f\n",
              smoothed.ate_m, smoothed.nees, filter.ate_m, filter.nees);
  EXPECT_LT(smoothed.ate_m, filter.ate_m);
  EXPECT_LT(smoothed.nees, 1.3);
  EXPECT_GT(smoothed.nees, 0.4);
}

/// What is said at the end is what a log that ends there would make of it, but for the world.
TEST(DriveSoFar, KnowsAllThatWasReadByThen) {
  ArenaOfPosts source(3, 201), again(3, 201);
  RangeBearingOptions options;
  options.smooth_every = 10;
  RangeBearingSession so_far(options, {}, {});
  so_far.run(source, [](const auto&...) { return true; });
  options.smooth_every = 0;
  RangeBearingSession at_the_end(options, {}, {});
  at_the_end.run(again, [](const auto&...) { return true; });
  const auto last = [](const Trajectory& t, std::size_t before) {
    return planarPart(t[before].T_world_body).inverse() * planarPart(t.back().T_world_body);
  };
  const Pose2 a = last(so_far.smoothed()->trajectory, 0);
  const Pose2 b = last(at_the_end.smoothed()->trajectory, 0);
  EXPECT_LT((a.vector() - b.vector()).norm(), 1e-3);
  const Pose2 said = so_far.now().T_world_origin.inverse() * so_far.now().T_world_robot;
  const Pose2 known = at_the_end.now().T_world_origin.inverse() *
                      planarPart(at_the_end.smoothed()->trajectory.front().T_world_body) * b;
  EXPECT_LT((said.translation() - known.translation()).norm(), 0.05);
}

/// Poses at the end lie about where they were said to be, however the start has turned out.
TEST(DriveSoFar, TheWorldLiesWherePosesWereSaid) {
  for (const bool with_map : {true, false}) {
    ArenaOfPosts source(5);
    RangeBearingOptions options;
    options.bearing_only = true;
    options.world_with_map = with_map;
    RangeBearingSession session(options, {}, {});
    session.run(source, [](const auto&...) { return true; });
    const Trajectory &said = session.trajectory(), &known = session.smoothed()->trajectory;
    std::vector<PointPair> pairs;
    for (std::size_t k = 0; k < said.size(); ++k)
      pairs.push_back({planarPart(said[k].T_world_body).translation(),
                       planarPart(known[k].T_world_body).translation()});
    const Pose2 apart = rigidFit(pairs);
    const Pose2 start = planarPart(known.front().T_world_body);
    if (with_map)
      EXPECT_LT(std::abs(apart.phi) + apart.translation().norm(), 0.03);
    else
      EXPECT_LT(start.vector().norm(), 1e-9);
    const Eigen::Vector2d here = session.now().T_world_robot.translation();
    EXPECT_LT((planarPart(known.back().T_world_body).translation() - here).norm(), 0.3);
    EXPECT_LT((session.now().T_world_origin.vector() - start.vector()).norm(), 0.3) << with_map;
  }
}

TEST(DriveSoFar, IsTheFiltersWhenNothingIsSmoothedMeanwhile) {
  for (const bool smooth : {true, false}) {
    RingOfPosts source(7);
    RangeBearingOptions options;
    options.smooth = smooth;
    options.smooth_every = smooth ? 0 : 10;
    RangeBearingSession session(options, {}, {});
    session.run(source, [&](const Frame&, const StepReport&, const auto& now) {
      EXPECT_EQ(now.now().T_world_robot.vector(), now.estimator().pose().vector());
      EXPECT_EQ(now.now().covariance, now.estimator().poseCovariance());
      return true;
    });
    EXPECT_EQ(session.now().T_world_filter.vector(), Pose2{}.vector());
  }
}

/// A loaded map holds the world: there the filter's word counts.
TEST(DriveSoFar, InALoadedMapItIsTheFilters) {
  RingOfPosts first(1), second(101);
  RangeBearingSession made({}, {}, {});
  made.run(first, [](const auto&...) { return true; });
  Resumption from;
  from.map = made.savedMap();
  from.localize = true;
  from.T_world_robot = from.map.T_world_start;
  from.covariance = Eigen::Vector3d(0.01, 0.01, 0.003).asDiagonal();
  RangeBearingSession session({}, {}, {}, from);
  session.run(second, [&](const Frame&, const StepReport&, const auto& now) {
    EXPECT_EQ(now.now().T_world_robot.vector(), now.estimator().pose().vector());
    return true;
  });
  const LandmarkMap map = made.map(), same = session.map();
  ASSERT_EQ(same.size(), map.size());
  for (std::size_t i = 0; i < map.size(); ++i)
    EXPECT_LT((same[i].p_world - map[i].p_world).norm(), 1e-9);
}

/// What a run gives away lies in one world, whether the end could be smoothed or not.
TEST(DriveSoFar, MapAndSavedMapLieWhereThePosesDo) {
  for (const bool ended : {true, false}) {
    ArenaOfPosts source(4);
    RangeBearingSession session({}, {}, {});
    std::size_t frames = 0;
    session.run(source, [&](const auto&...) { return ++frames < (ended ? 1000 : 500); });
    ASSERT_EQ(session.smoothed().has_value(), ended);
    EXPECT_GT(session.now().T_world_filter.vector().norm(), 1e-4);
    const SavedMap saved = session.savedMap();
    const Eigen::Vector2d start =
        ended ? planarPart(session.smoothed()->trajectory.front().T_world_body).translation()
              : session.now().T_world_origin.translation();
    EXPECT_LT((saved.T_world_start.translation() - start).norm(), 0.1) << ended;
    std::size_t found = 0;
    for (const LandmarkRecord& landmark : session.map())
      for (const Block& block : saved.state.blocks)
        found += (Eigen::Vector2d(saved.state.values(block)) - landmark.p_world).norm() < 1e-6;
    EXPECT_EQ(found, session.map().size()) << ended;
  }
}

/// A log may begin long before anything is seen.
TEST(DriveSoFar, BeginsWithTheFirstReading) {
  RingOfPosts source(9, 0, 300);
  source.blind = 120;
  RangeBearingSession session({}, {}, {});
  std::size_t frames = 0;
  session.run(source, [&](const Frame&, const StepReport&, const auto& now) {
    const bool is_filters = now.now().T_world_robot.vector() == now.estimator().pose().vector();
    ++frames;
    EXPECT_TRUE(is_filters || frames > 120) << frames;
    return true;
  });
  EXPECT_GT(session.now().T_world_filter.vector().norm(), 1e-6);
}

/// Every frame is said once, also before anything can be smoothed.
TEST(DriveSoFar, SaysEveryFrame) {
  for (const int every : {1, 7, 1000}) {
    RingOfPosts source(9, 0, 50);
    source.blind = 20;
    RangeBearingOptions options;
    options.smooth_every = every;
    RangeBearingSession session(options, {}, {});
    std::size_t frames = 0;
    session.run(source, [&](const auto&...) { return ++frames < 45; });
    EXPECT_EQ(session.trajectory().size(), 45u);
    for (const StampedPose& pose : session.trajectory())
      EXPECT_TRUE(pose.T_world_body.matrix().allFinite());
    EXPECT_TRUE(session.now().covariance.allFinite());
  }
}

}  // namespace
}  // namespace colonnade
