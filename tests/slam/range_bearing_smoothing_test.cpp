// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/filter/covariance.hpp"
#include "colonnade/frames/mrclam_import.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/slam/range_bearing_session.hpp"
#include "ring_of_posts.hpp"
#include "shared_data.hpp"
#include "temporary_folder.hpp"

namespace colonnade {
namespace {

using testing::RingOfPosts;

struct Errors {
  double online_m = 0.0;
  double final_m = 0.0;
};

/// ATE of the poses of the moment and of those at the end.
Errors errorsOf(FrameSource& source, const Trajectory& truth, const RangeBearingOptions& options) {
  RangeBearingSession session(options, {}, {});
  Trajectory online;
  session.run(source, [&](const Frame& frame, const StepReport&, const auto& now) {
    online.push_back({frame.stamp_s, now.now().T_world_robot.toIsometry3()});
    return true;
  });
  EXPECT_TRUE(session.smoothed() && session.smoothed()->how.converged);
  return {evaluateTrajectory(online, truth).ate_rmse_m,
          evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m};
}

double ateOf(const RangeBearingSession& session, const Trajectory& truth) {
  return evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m;
}

TEST(RangeBearingSmoothing, TheWholeLogKnowsEarlierPosesBetter) {
  for (const bool known : {true, false}) {
    RangeBearingOptions options;
    options.use_ids = known;
    double online = 0.0, final = 0.0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      RingOfPosts source(seed);
      RingOfPosts ahead(seed);
      while (ahead.next()) continue;
      const Errors errors = errorsOf(source, ahead.truth, options);
      online += errors.online_m;
      final += errors.final_m;
    }
    EXPECT_LT(final, 0.85 * online) << known;
  }
}

TEST(RangeBearingSmoothing, MovesTheMapButNotItsNames) {
  RingOfPosts source(3), again(3);
  RangeBearingOptions options;
  RangeBearingSession smoothed(options, {}, {});
  options.smooth = false;
  RangeBearingSession plain(options, {}, {});
  smoothed.run(source, [](const auto&...) { return true; });
  plain.run(again, [](const auto&...) { return true; });
  EXPECT_FALSE(plain.smoothed());
  const LandmarkMap a = smoothed.map(), b = plain.map();
  ASSERT_EQ(a.size(), b.size());
  double moved = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].p_world, a[i].extent_a);
    moved += (a[i].p_world - b[i].p_world).norm();
    EXPECT_LT((a[i].p_world - b[i].p_world).norm(), 0.3);
    EXPECT_GT(a[i].covariance.determinant(), 0.0);
  }
  EXPECT_GT(moved, 0.0);
}

/// Where identities are hidden the drive as they tell it is weighed, too.
TEST(RangeBearingSmoothing, SaysWhatTheLogsIdentitiesWouldCost) {
  for (const bool known : {true, false}) {
    RingOfPosts source(9);
    RangeBearingOptions options;
    options.use_ids = known;
    RangeBearingSession session(options, {}, {});
    session.run(source, [](const auto&...) { return true; });
    ASSERT_TRUE(session.smoothed());
    EXPECT_EQ(session.smoothed()->cost_of_identities.has_value(), !known);
    if (known) continue;
    EXPECT_EQ(session.identityScore().rightShare(), 1.0);
    EXPECT_NEAR(*session.smoothed()->cost_of_identities, session.smoothed()->how.cost,
                1e-3 * session.smoothed()->how.cost);
  }
}

/// A log that tells wrong identities now and then would cost more by them.
TEST(RangeBearingSmoothing, WrongIdentitiesCost) {
  class Lying : public RingOfPosts {
   public:
    Lying() : RingOfPosts(9) {}
    std::optional<Frame> next() override {
      auto frame = RingOfPosts::next();
      if (frame && truth.size() % 10 == 0 && !frame->range_bearing->readings.empty()) {
        int& identity = frame->range_bearing->readings.front().id;
        identity = 1 + (identity + 1) % kPosts;  // the next post on this side
      }
      return frame;
    }
  } source;
  RangeBearingOptions options;
  options.use_ids = false;
  RangeBearingSession session(options, {}, {});
  session.run(source, [](const auto&...) { return true; });
  ASSERT_TRUE(session.smoothed());
  EXPECT_LT(session.identityScore().rightShare(), 1.0);
  EXPECT_GT(*session.smoothed()->cost_of_identities, session.smoothed()->how.cost + 100.0);
}

TEST(RangeBearingSmoothing, ALogWithoutReadingsStaysAsItIs) {
  class Nothing : public RingOfPosts {
   public:
    Nothing() : RingOfPosts(1) {}
    std::optional<Frame> next() override {
      auto frame = RingOfPosts::next();
      if (frame) frame->range_bearing->readings.clear();
      return frame;
    }
  } source;
  RangeBearingSession session({}, {}, {});
  session.run(source, [](const auto&...) { return true; });
  EXPECT_FALSE(session.smoothed());
  EXPECT_TRUE(session.map().empty());
}

TEST(RangeBearingSmoothing, AnInterruptedRunIsNotSmoothed) {
  RingOfPosts source(4);
  RangeBearingSession session({}, {}, {});
  session.run(source, [](const Frame& frame, const auto&...) { return frame.stamp_s < 20.0; });
  EXPECT_FALSE(session.smoothed());
  EXPECT_FALSE(session.map().empty());
}

/// A sensor that is off is named; where its errors are estimated they are found, and the map is
/// free of them.
TEST(RangeBearingSmoothing, WhatTheSensorIsOffByIsFound) {
  const SensorErrors off{0.04, 0.0, -0.06, 0.02, 0.01};
  double with_m = 0.0, without_m = 0.0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto longDrive = [&] {
      RingOfPosts ring(seed, 0, 4 * RingOfPosts::kSteps, 5.0, 0.9);
      ring.wheel_noise = 0.03;
      ring.direction = seed % 2 == 0 ? kPi : 0.0;
      return ring;
    };
    RingOfPosts source = longDrive(), again = longDrive(), right = longDrive();
    source.sensor = again.sensor = off;
    RangeBearingOptions options;
    RangeBearingSession taken_as_right(options, {}, {});
    taken_as_right.run(source, [](const auto&...) { return true; });
    ASSERT_EQ(taken_as_right.notes().size(), 1u) << seed;
    EXPECT_NE(taken_as_right.notes().front().find("the sensor seems to read"), std::string::npos)
        << taken_as_right.notes().front();
    EXPECT_FALSE(taken_as_right.sensor());
    without_m += ateOf(taken_as_right, source.truth);

    RangeBearingSession of_right_sensor(options, {}, {});
    of_right_sensor.run(right, [](const auto&...) { return true; });
    EXPECT_TRUE(of_right_sensor.notes().empty());

    options.estimate_sensor = true;
    RangeBearingSession estimated(options, {}, {});
    estimated.run(again, [](const auto&...) { return true; });
    EXPECT_TRUE(estimated.notes().empty());
    ASSERT_TRUE(estimated.sensor());
    const auto sensor = *estimated.sensor();
    const SensorErrors::Vector wrong = sensor.errors.vector() - off.vector();
    EXPECT_LT(wrong.dot(sensor.covariance.ldlt().solve(wrong)), 25.7);  // 0.9999
    EXPECT_LT(std::sqrt(sensor.covariance(2, 2)), 0.015);
    with_m += ateOf(estimated, again.truth);
    for (const Block& block : estimated.savedMap().state.blocks)
      EXPECT_EQ(block.block_kind, BlockKind::kPoint);
  }
  EXPECT_LT(with_m, 0.8 * without_m);
}

/// Only what is sure is said.
TEST(RangeBearingSmoothing, TheNoteNamesWhatIsOff) {
  RingOfPosts source(2, 0, 4 * RingOfPosts::kSteps, 5.0, 0.9);
  source.wheel_noise = 0.03;
  source.sensor.range_skew = 0.1;
  RangeBearingSession session({}, {}, {});
  session.run(source, [](const auto&...) { return true; });
  ASSERT_EQ(session.notes().size(), 1u);
  const std::string note = session.notes().front();
  EXPECT_NE(note.find(" % longer for each radian to the left; if"), std::string::npos) << note;
  EXPECT_EQ(note.find("bearings"), std::string::npos) << note;
}

/// Motions the filter did not take are no part of the drive.
TEST(RangeBearingSmoothing, ARobotThatWaitsForItsFirstLandmark) {
  class BlindAtFirst : public RingOfPosts {
   public:
    BlindAtFirst() : RingOfPosts(5) {}
    std::optional<Frame> next() override {
      auto frame = RingOfPosts::next();
      if (frame && truth.size() < 40) frame->range_bearing->readings.clear();
      return frame;
    }
  } source;
  RangeBearingOptions options;
  options.wait_for_landmark = true;
  RangeBearingSession session(options, {}, {});
  session.run(source, [](const auto&...) { return true; });
  ASSERT_TRUE(session.smoothed());
  EXPECT_TRUE(session.smoothed()->how.converged);
  EXPECT_LT(session.smoothed()->how.steps, 30);
  Trajectory seen(source.truth.begin() + 39, source.truth.end());
  EXPECT_LT(evaluateTrajectory(session.smoothed()->trajectory, seen).ate_rmse_m, 0.5);
}

struct RealDrive {
  std::filesystem::path log;
  Trajectory truth;
};

/// Of a robot of UTIAS MRCLAM data set 7.
RealDrive realDrive(const std::filesystem::path& data, int robot,
                    const std::filesystem::path& folder) {
  MrclamImportOptions import;
  import.folder = data;
  import.robot = robot;
  import.log = folder / ("robot" + std::to_string(robot) + ".rawlog");
  importMrclam(import);
  return {import.log, readTum(folder / ("robot" + std::to_string(robot) + "_ground_truth.tum"))};
}

/// What the whole log says against the poses of the moment.
TEST(RangeBearingSmoothing, RealRobots) {
  COLONNADE_REQUIRE_RECORDING(folder, "mrclam7");
  const testing::TemporaryFolder out;
  for (const int robot : {1, 3, 5}) {
    const auto [path, truth] = realDrive(folder, robot, out.path());
    for (const bool bearing_only : {false, true}) {
      RangeBearingOptions options;
      options.bearing_only = bearing_only;
      RawlogSource log(path);
      const Errors errors = errorsOf(log, truth, options);
      std::printf("robot %d, %s: ATE %.3f m at the moment, %.3f afterwards\n", robot,
                  bearing_only ? "bearings" : "with ranges", errors.online_m, errors.final_m);
      EXPECT_LT(errors.final_m, 0.95 * errors.online_m) << robot << bearing_only;
      EXPECT_LT(errors.online_m, bearing_only ? 0.25 : 0.1) << robot << bearing_only;
      EXPECT_LT(errors.final_m, 0.15) << robot << bearing_only;
    }
  }
}

/// Identities hidden, among neighbours 0.18 m apart, also where the sigmas are not the best ones.
TEST(RangeBearingSmoothing, RealRobotsSortOutWhatTheySee) {
  COLONNADE_REQUIRE_RECORDING(folder, "mrclam7");
  constexpr std::size_t kPosts = 15;
  const testing::TemporaryFolder out;
  for (const int robot : {1, 5}) {
    const auto [path, truth] = realDrive(folder, robot, out.path());
    for (const double bearing_sigma : {0.0, radians(1.0)}) {
      RangeBearingOptions options;
      options.use_ids = false;
      options.bearing_sigma = bearing_sigma;
      RawlogSource log(path);
      RangeBearingSession session(options, {}, {});
      session.run(log, [](const auto&...) { return true; });
      EXPECT_LT(evaluateTrajectory(session.trajectory(), truth).ate_rmse_m, 0.15)
          << robot << bearing_sigma;
      ASSERT_TRUE(session.smoothed());
      EXPECT_LT(evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m, 0.1)
          << robot << bearing_sigma;
      EXPECT_GT(session.identityScore().rightShare(), 0.85);
      // Most of those founded twice are one at the end, for all who ask.
      const LandmarkMap map = session.map();
      const SavedMap saved = session.savedMap();
      EXPECT_LE(map.size(), kPosts + 4) << robot << bearing_sigma;
      if (!session.smoothed()->explained_backwards) {
        EXPECT_EQ(map.size() + session.smoothed()->merged.size(), session.estimator().map().size());
      }
      ASSERT_EQ(saved.state.blocks.size(), map.size());
      for (std::size_t i = 0; i < map.size(); ++i) {
        EXPECT_EQ(saved.state.blocks[i].id, map[i].id);
        EXPECT_EQ(saved.state.blocks[i].evidence.observations, map[i].observations);
      }
      for (const auto& [gone, into] : session.smoothed()->merged) {
        EXPECT_EQ(saved.state.find(gone), nullptr);
        EXPECT_NE(saved.state.find(into), nullptr);
      }
    }
  }
}

/// What was founded beside landmarks of the map that was loaded becomes one with them, and those
/// stay.
TEST(RangeBearingSmoothing, ASecondRobotGoesOnInTheMapOfTheFirst) {
  COLONNADE_REQUIRE_RECORDING(folder, "mrclam7");
  const testing::TemporaryFolder out;
  RangeBearingOptions options;
  options.use_ids = false;
  Resumption from;
  {
    RawlogSource log(realDrive(folder, 1, out.path()).log);
    RangeBearingSession first(options, {}, {});
    first.run(log, [](const auto&...) { return true; });
    from.map = first.savedMap();
  }
  State& state = from.map.state;  // and something the second one never sees
  const Eigen::Vector2d nowhere(100.0, 100.0);
  const LandmarkId unseen{number(state.blocks.back().id) + 1};
  augment(state, {unseen, BlockKind::kPoint, LandmarkKind::kPillarEdge, 0, {}}, nowhere,
          SparseJacobian(2), 1e-4 * Eigen::Matrix2d::Identity());
  from.anywhere = PlaceOptions{};
  const auto [path, truth] = realDrive(folder, 5, out.path());
  RawlogSource log(path);
  RangeBearingSession session(options, {}, {}, from);
  session.run(log, [](const auto&...) { return true; });
  ASSERT_EQ(session.search(), nullptr);
  ASSERT_TRUE(session.smoothed());
  EXPECT_LT(evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m, 0.1);
  const auto& merged = session.smoothed()->merged;
  EXPECT_FALSE(merged.empty());
  const LandmarkMap map = session.map();
  EXPECT_LE(map.size(), state.blocks.size() + 4);
  const auto isInMap = [&](LandmarkId id) {
    return std::any_of(map.begin(), map.end(), [&](const auto& m) { return m.id == id; });
  };
  for (const Block& block : state.blocks) EXPECT_TRUE(isInMap(block.id));
  const State all = session.filter().fullState();
  for (const auto& [gone, into] : merged) {
    EXPECT_FALSE(isInMap(gone));
    EXPECT_TRUE(isInMap(into));
    const Eigen::Vector2d p = all.values(*all.find(gone)).head<2>();
    EXPECT_LT((p - all.values(*all.find(into)).head<2>()).norm(), 0.5);
  }
  for (const LandmarkRecord& landmark : map)
    EXPECT_EQ((landmark.p_world - nowhere).norm() < 1.0, landmark.id == unseen);
  writeFileAtomically(out.path() / "map.colonnade", MapFile::text(session.savedMap()));
  const SavedMap saved = MapFile::read(out.path() / "map.colonnade");
  ASSERT_EQ(saved.state.blocks.size(), map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Block& block = saved.state.blocks[i];
    EXPECT_EQ(block.id, map[i].id);
    EXPECT_LT((saved.state.values(block) - map[i].p_world).norm(), 1e-9);
    EXPECT_LT((saved.state.P.block<2, 2>(block.offset, block.offset) - map[i].covariance).norm(),
              1e-9);
  }
}

}  // namespace
}  // namespace colonnade
