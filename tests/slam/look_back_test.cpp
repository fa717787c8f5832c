// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Logs of hidden identities, explained once more from their end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "arena_of_posts.hpp"
#include "backwards.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/slam/range_bearing_session.hpp"
#include "numeric_jacobian.hpp"

namespace colonnade {
namespace {

using testing::ArenaOfPosts;

RangeBearingOptions hidden(bool look_back = true) {
  RangeBearingOptions options;
  options.use_ids = false;
  options.look_back = look_back;
  return options;
}

/// Posts in threes, 0.3 m apart, of which the robot reads hardly ever two at a time.
ArenaOfPosts hardArena(unsigned seed) { return ArenaOfPosts(seed, 800, 3, 0.25); }

double finalAte(const RangeBearingSession& session, const Trajectory& truth) {
  return evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m;
}

/// Neighbours are taken for each other before the map is known. From the end they are not.
TEST(LookBack, PutsRightWhatWentWrongEarly) {
  double without = 0.0, with = 0.0;
  for (const unsigned seed : {1U, 8U, 22U}) {
    ArenaOfPosts source = hardArena(seed), again = hardArena(seed);
    RangeBearingSession forwards(hidden(false), {}, {}), both(hidden(), {}, {});
    forwards.run(source, [](const auto&...) { return true; });
    both.run(again, [](const auto&...) { return true; });
    ASSERT_TRUE(forwards.smoothed() && both.smoothed());
    EXPECT_FALSE(forwards.smoothed()->explained_backwards);
    EXPECT_LE(both.smoothed()->surprise, forwards.smoothed()->surprise);
    EXPECT_LT(finalAte(both, again.truth), 0.1) << seed;
    without += finalAte(forwards, source.truth);
    with += finalAte(both, again.truth);
  }
  std::printf("sum of ATE: %.3f m, %.3f with a look back\n", without, with);
  EXPECT_LT(with, 0.5 * without);
}

/// All who ask are told the same, and the poses of the moment stay what they were.
TEST(LookBack, ChangesTheMapAsAWhole) {
  ArenaOfPosts source = hardArena(22), again = hardArena(22);
  RangeBearingSession session(hidden(), {}, {}), forwards(hidden(false), {}, {});
  session.run(source, [](const auto&...) { return true; });
  forwards.run(again, [](const auto&...) { return true; });
  ASSERT_TRUE(session.smoothed() && session.smoothed()->explained_backwards);
  for (std::size_t k = 0; k < session.trajectory().size(); ++k)
    ASSERT_EQ(session.trajectory()[k].T_world_body.matrix(),
              forwards.trajectory()[k].T_world_body.matrix());
  ASSERT_EQ(session.smoothed()->trajectory.size(), session.trajectory().size());
  for (std::size_t k = 0; k < session.trajectory().size(); ++k)
    ASSERT_EQ(session.smoothed()->trajectory[k].stamp_s, session.trajectory()[k].stamp_s);
  const LandmarkMap map = session.map();
  const SavedMap saved = session.savedMap();
  ASSERT_EQ(saved.state.blocks.size(), map.size());
  std::map<LandmarkId, int> readings;
  for (const auto& landmark : session.smoothed()->decisions)
    if (landmark) ++readings[*landmark];
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_TRUE(i == 0 || map[i - 1].id < map[i].id);
    EXPECT_EQ(saved.state.blocks[i].id, map[i].id);
    EXPECT_EQ(saved.state.blocks[i].evidence.observations, map[i].observations);
    EXPECT_EQ(readings[map[i].id], map[i].observations);
    EXPECT_LE(map[i].first_stamp_s, map[i].last_stamp_s);
    EXPECT_GE(map[i].first_stamp_s, session.trajectory().front().stamp_s);
    EXPECT_LE(map[i].last_stamp_s, session.trajectory().back().stamp_s);
    readings.erase(map[i].id);
  }
  EXPECT_TRUE(readings.empty()) << "readings of landmarks that are not in the map";
  EXPECT_GT(session.identityScore().rightShare(), forwards.identityScore().rightShare());
}

/// Where every decision is clear the way back decides the same, by the same names.
TEST(LookBack, AgreesWhereNothingIsInDoubt) {
  const std::vector<Eigen::Vector2d> posts{{2.0, 1.0}, {3.5, -1.0}, {5.0, 1.2}, {6.0, -1.1}};
  RangeBearingEstimator estimator(hidden(), {});
  DriveRecord record;
  DriveSoFar so_far;
  MotionIncrement motion;
  Pose2 T_world_robot;
  for (int k = 0; k < 60; ++k) {
    RangeBearingScan scan;
    scan.range_sigma_m = 0.03;
    scan.yaw_sigma = radians(0.5);
    for (const Eigen::Vector2d& post : posts) {
      const Eigen::Vector2d p = transform(T_world_robot.inverse(), post);
      if (p.x() > 0.5) scan.readings.push_back({-1, p.norm(), std::atan2(p.y(), p.x()), 0.0, {}});
    }
    const auto report = estimator.step(0.5 * k, motion, scan);
    record.add(0.5 * k, scan, report);
    so_far.follow(estimator, report.motion_covariance);
    motion = {{0.08, 0.0, 0.01}, 1e-5 * Eigen::Matrix3d::Identity(), MotionSource::kOdometry};
    T_world_robot = T_world_robot * motion.T_previous_robot;
  }
  const Explanation forwards = explanationOf(record, so_far, estimator, false);
  const Explanation backwards = explainedBackwards(record, forwards, hidden(), {});
  ASSERT_EQ(backwards.T_world_robot.size(), forwards.T_world_robot.size());
  EXPECT_LT(
      (backwards.T_world_robot.front().vector() - forwards.T_world_robot.front().vector()).norm(),
      1e-9);
  ASSERT_EQ(backwards.decisions.size(), forwards.decisions.size());
  EXPECT_EQ(backwards.decisions, forwards.decisions);
  EXPECT_EQ(backwards.map.size(), posts.size());
  for (const LandmarkRecord& landmark : forwards.map) {
    const auto twin = std::find_if(backwards.map.begin(), backwards.map.end(),
                                   [&](const auto& other) { return other.id == landmark.id; });
    ASSERT_NE(twin, backwards.map.end());
    EXPECT_EQ(twin->first_stamp_s, landmark.first_stamp_s);
    EXPECT_EQ(twin->last_stamp_s, landmark.last_stamp_s);
  }
}

TEST(LookBack, TheWayBackIsAsUnsureAsTheWayThere) {
  const Drive::Motion there{{0.3, -0.1, 0.8},
                            Eigen::Vector3d(1e-3, 4e-4, 9e-4).asDiagonal().toDenseMatrix()};
  const MotionIncrement back = reversed(there);
  EXPECT_LT((there.T_previous_robot * back.T_previous_robot).vector().norm(), 1e-12);
  EXPECT_TRUE(back.isMeasured());
  const Eigen::Matrix3d J = testing::numericJacobian(
      [](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        return Pose2{v(0), v(1), v(2)}.inverse().vector();
      },
      there.T_previous_robot.vector());
  EXPECT_LT((back.covariance - J * there.covariance * J.transpose()).norm(), 1e-9);
}

TEST(LookBack, HasNothingToDecideWhereIdentitiesAreKnown) {
  ArenaOfPosts source = hardArena(22);
  RangeBearingSession session({}, {}, {});
  session.run(source, [](const auto&...) { return true; });
  ASSERT_TRUE(session.smoothed());
  EXPECT_FALSE(session.smoothed()->explained_backwards);
}

/// Some readings without identity, some that are none.
class SpoiltReadings : public FrameSource {
 public:
  explicit SpoiltReadings(ArenaOfPosts arena) : arena_(std::move(arena)) {}
  std::optional<Frame> next() override {
    auto frame = arena_.next();
    if (!frame) return frame;
    for (RangeBearing& reading : frame->range_bearing->readings) {
      if (readings % 2 == 0) reading.id = -1;
      if (readings % 7 == 3) reading.range_m = std::nan("");
      ++readings;
    }
    return frame;
  }
  const Damage& damage() const override { return arena_.damage(); }
  double progress() const override { return 0.0; }
  const Trajectory& truth() const { return arena_.truth; }

  std::size_t readings = 0;

 private:
  ArenaOfPosts arena_;
};

TEST(LookBack, KeepsReadingsApartFromThoseThatAreNone) {
  SpoiltReadings source(ArenaOfPosts(3));
  RangeBearingOptions options;
  RangeBearingEstimator estimator(options, {});
  DriveRecord record;
  DriveSoFar so_far;
  MotionEstimator wheels({}, nullptr);
  while (const auto frame = source.next()) {
    const auto report =
        estimator.step(frame->stamp_s, wheels.increment(*frame), *frame->range_bearing);
    record.add(frame->stamp_s, *frame->range_bearing, report);
    so_far.follow(estimator, report.motion_covariance);
    so_far.catchUp(record, estimator, options);
  }
  const Explanation forwards = explanationOf(record, so_far, estimator, false);
  const Explanation backwards = explainedBackwards(record, forwards, options, {});
  ASSERT_EQ(backwards.decisions.size(), source.readings);
  for (std::size_t i = 3; i < source.readings; i += 7) EXPECT_FALSE(backwards.decisions[i]);
  for (const auto& [landmark, identity] : backwards.identities) {
    EXPECT_GT(identity, 0);
    for (std::size_t i = 0; i < source.readings; ++i)
      if (backwards.decisions[i] == landmark && record.readings[i].identity > 0) {
        EXPECT_EQ(record.readings[i].identity, identity);
      }
  }
  const auto smoothed = smoothedDrive(record, backwards, so_far, options);
  ASSERT_TRUE(smoothed);
  EXPECT_LT(evaluateTrajectory(smoothed->trajectory, source.truth()).ate_rmse_m, 0.1);
}

TEST(LookBack, TakesLogsOfAFrameOrTwo) {
  for (const std::size_t frames : {0U, 1U, 2U, 3U}) {
    ArenaOfPosts source(22, frames, 3, 1.0);
    RangeBearingSession session(hidden(), {}, {});
    session.run(source, [](const auto&...) { return true; });
    EXPECT_EQ(session.trajectory().size(), frames);
    EXPECT_EQ(session.savedMap().state.blocks.size(), session.map().size());
  }
}

}  // namespace
}  // namespace colonnade
