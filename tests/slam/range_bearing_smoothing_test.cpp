// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "colonnade/evaluation/trajectory_score.hpp"
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
    online.push_back({frame.stamp_s, now.estimator().pose().toIsometry3()});
    return true;
  });
  EXPECT_TRUE(session.smoothed() && session.smoothed()->how.converged);
  return {evaluateTrajectory(online, truth).ate_rmse_m,
          evaluateTrajectory(session.smoothed()->trajectory, truth).ate_rmse_m};
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

/// UTIAS MRCLAM data set 7: what the whole log says against the poses of the moment.
TEST(RangeBearingSmoothing, RealRobots) {
  COLONNADE_REQUIRE_RECORDING(folder, "mrclam7");
  const testing::TemporaryFolder out;
  for (const int robot : {1, 3, 5}) {
    MrclamImportOptions import;
    import.folder = folder;
    import.robot = robot;
    import.log = out.path() / ("robot" + std::to_string(robot) + ".rawlog");
    importMrclam(import);
    const Trajectory truth =
        readTum(out.path() / ("robot" + std::to_string(robot) + "_ground_truth.tum"));
    for (const bool bearing_only : {false, true}) {
      RangeBearingOptions options;
      options.bearing_only = bearing_only;
      RawlogSource log(import.log);
      const Errors errors = errorsOf(log, truth, options);
      EXPECT_LT(errors.final_m, 0.95 * errors.online_m) << robot << bearing_only;
      EXPECT_LT(errors.final_m, 0.15) << robot << bearing_only;
    }
  }
}

}  // namespace
}  // namespace colonnade
