// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Maps of landmark readings, saved and loaded.
#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <fstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/rigid_fit.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/frames/mrclam_import.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/slam/mapper.hpp"
#include "colonnade/slam/range_bearing_session.hpp"
#include "colonnade/slam/range_bearing_slam.hpp"
#include "ring_of_posts.hpp"
#include "shared_data.hpp"
#include "temporary_folder.hpp"

namespace colonnade {
namespace {

using testing::RingOfPosts;

constexpr std::size_t kStartOfDay2 = 45;

/// Sees so much at a time that the world's direction is known from the start.
RingOfPosts ring(unsigned seed, std::size_t first_step = kStartOfDay2,
                 std::size_t steps = 2 * RingOfPosts::kSteps) {
  return RingOfPosts(seed, first_step, steps, 6.0, 1.2);
}

/// Where the truth lies in the world of a map: no drive knows its first heading exactly.
Pose2 alignment(const LandmarkMap& map) {
  std::vector<PointPair> posts;
  for (const LandmarkRecord& landmark : map)
    posts.push_back({landmark.p_world, RingOfPosts::post(number(landmark.id))});
  return rigidFit(posts);
}

/// Root mean square distance of the poses from the truth in this world.
double rms(const Trajectory& estimate, const Trajectory& truth, const Pose2& T_map_truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += (estimate[i].T_world_body.translation().head<2>() -
            transform(T_map_truth, truth[i].T_world_body.translation().head<2>()))
               .squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

/// Of the places within the map.
double rmsOfPosts(const LandmarkMap& map) {
  const Pose2 T_map_truth = alignment(map);
  double sum = 0.0;
  for (const LandmarkRecord& landmark : map)
    sum += (landmark.p_world - transform(T_map_truth, RingOfPosts::post(number(landmark.id))))
               .squaredNorm();
  return std::sqrt(sum / static_cast<double>(map.size()));
}

struct Day {
  Trajectory online, final;
  std::size_t births = 0;
  int placed_after = -1;  ///< frames; never: -1
  LandmarkMap map;
  SavedMap saved;
  std::map<std::string, std::size_t> refused;
};

Day drive(RingOfPosts& source, const RangeBearingOptions& options,
          std::optional<Resumption> from = std::nullopt) {
  RangeBearingSession session(options, {}, {}, std::move(from));
  Day day;
  session.run(source, [&](const Frame& frame, const StepReport& report, const auto& now) {
    if (!now.search() && day.placed_after < 0)
      day.placed_after = static_cast<int>(day.online.size());
    day.online.push_back({frame.stamp_s, now.estimator().pose().toIsometry3()});
    for (const Event& event : report.events) day.births += event.what == "birth" ? 1 : 0;
    return true;
  });
  EXPECT_TRUE(session.smoothed().has_value());
  if (session.smoothed()) day.final = session.smoothed()->trajectory;
  day.map = session.map();
  day.saved = session.savedMap();
  for (const auto& [reason, count] : session.filter().health().refused())
    day.refused[reason] = count;
  return day;
}

const Day& firstDay() {
  static const Day day = [] {
    RingOfPosts source = ring(1, 0);
    return drive(source, {});
  }();
  return day;
}

const Pose2& world() {
  static const Pose2 T = alignment(firstDay().map);
  return T;
}

/// The second day starts elsewhere on the ring, and where exactly is not known.
Resumption resumption(bool localize) {
  Resumption from;
  from.map = firstDay().saved;
  from.localize = localize;
  from.T_world_robot = RingOfPosts::poseAfter(1).inverse() *
                       RingOfPosts::poseAfter(kStartOfDay2 + 1) * Pose2{0.1, -0.08, radians(2.0)};
  from.covariance = MapStart::startCovariance(0.1, radians(2.0));
  return from;
}

void expectSamePlaces(const SavedMap& now, const SavedMap& then) {
  EXPECT_TRUE(now.state.x == then.state.x);
  EXPECT_TRUE(now.state.P == then.state.P);
  EXPECT_TRUE(now.identities == then.identities);
}

class ReadingMaps : public ::testing::Test {
 protected:
  std::filesystem::path write(const SavedMap& map) {
    std::ofstream(folder_ / "map.colonnade", std::ios::binary) << MapFile::text(map);
    return folder_ / "map.colonnade";
  }
  testing::TemporaryFolder folder_;
};

TEST_F(ReadingMaps, HoldWhatTheCsvShowsAndReadBackAsTheyWere) {
  const SavedMap& map = firstDay().saved;
  EXPECT_EQ(map.source, SavedMap::Source::kReadings);
  ASSERT_EQ(map.identities.size(), static_cast<std::size_t>(RingOfPosts::kPosts));
  ASSERT_EQ(firstDay().map.size(), map.identities.size());
  for (const auto& [id, identity] : map.identities) {
    const Block& block = *map.state.find(id);
    const LandmarkRecord& record = firstDay().map[static_cast<std::size_t>(identity - 1)];
    EXPECT_EQ(Eigen::Vector2d(map.state.values(block)), record.p_world);
    EXPECT_EQ((map.state.P.block<2, 2>(block.offset, block.offset)), record.covariance);
  }
  EXPECT_TRUE(MapFile::text(MapFile::read(write(map))) == MapFile::text(map));
}

TEST_F(ReadingMaps, ServeToLocaliseWithoutChanging) {
  for (const bool known : {true, false}) {
    RangeBearingOptions options;
    options.use_ids = known;
    RingOfPosts source = ring(2);
    const Day day = drive(source, options, resumption(true));
    EXPECT_EQ(day.births, 0u);
    EXPECT_LT(rms(day.online, source.truth, world()), 0.12) << known;  // the wheels alone: 0.5 m
    EXPECT_LT(rms(day.final, source.truth, world()), 0.06) << known;
    expectSamePlaces(day.saved, firstDay().saved);
  }
}

TEST_F(ReadingMaps, ServeBearingsAlone) {
  RangeBearingOptions options;
  options.bearing_only = true;
  RingOfPosts source = ring(3);
  const Day day = drive(source, options, resumption(true));
  EXPECT_EQ(day.births, 0u);
  EXPECT_LT(rms(day.online, source.truth, world()), 0.12);
  EXPECT_LT(rms(day.final, source.truth, world()), 0.06);
}

TEST_F(ReadingMaps, GrowBetterAndNotLarger) {
  double before = 0.0, after = 0.0;
  for (unsigned seed = 11; seed < 19; ++seed) {
    RingOfPosts source = ring(seed);
    const Day day = drive(source, {}, resumption(false));
    EXPECT_EQ(day.map.size(), firstDay().map.size());
    EXPECT_EQ(day.births, 0u);
    EXPECT_LT(rms(day.final, source.truth, world()), 0.06) << seed;
    EXPECT_EQ(day.saved.T_world_start.vector(), firstDay().saved.T_world_start.vector());
    before += rmsOfPosts(firstDay().map);
    after += rmsOfPosts(day.map);
    for (std::size_t i = 0; i < day.map.size(); ++i)
      EXPECT_LT(day.map[i].covariance.trace(), firstDay().map[i].covariance.trace());
  }
  EXPECT_LT(after, 0.95 * before);
}

/// A map that holds a post twice, in a place each, is rid of the second when the drive goes on in
/// it; one that is left as it is keeps both.
TEST_F(ReadingMaps, AreRidOfWhatTheyHoldTwice) {
  for (const bool localize : {false, true}) {
    Resumption from = resumption(localize);
    from.map.identities.clear();
    State& state = from.map.state;
    const Block post = state.blocks[5];
    Block twin = post;
    twin.id = LandmarkId{number(state.blocks.back().id) + 1};
    augment(state, twin, state.values(post) + Eigen::Vector2d(0.25, 0.1),
            SparseJacobian(2).add(0, post.offset, Eigen::Matrix2d::Identity()),
            0.15 * 0.15 * Eigen::Matrix2d::Identity());
    RangeBearingOptions options;
    options.use_ids = false;
    RingOfPosts source = ring(6);
    const Day day = drive(source, options, from);
    const bool is_there =
        std::any_of(day.map.begin(), day.map.end(), [&](const auto& l) { return l.id == twin.id; });
    const bool other_is_there =
        std::any_of(day.map.begin(), day.map.end(), [&](const auto& l) { return l.id == post.id; });
    EXPECT_EQ(day.map.size(), firstDay().map.size() + (localize ? 1u : 0u));
    EXPECT_EQ(is_there && other_is_there, localize);
    EXPECT_TRUE(is_there || other_is_there);
    EXPECT_EQ(day.saved.state.blocks.size(), day.map.size());
  }
}

/// A sensor that is off finds its way in the map of another one and makes it no worse, as long as
/// its errors are estimated. The map knows nothing of the sensor.
TEST_F(ReadingMaps, ServeOtherSensors) {
  for (const bool use_ids : {true, false}) {
    for (const bool localize : {true, false}) {
      RangeBearingOptions options;
      options.use_ids = use_ids;
      double off_m[2] = {0.0, 0.0};
      for (const bool estimate : {false, true}) {
        options.estimate_sensor = estimate;
        RingOfPosts source = ring(21);
        source.sensor = {0.08, 0.03, -0.06, 0.02, 0.01};
        const Day day = drive(source, options, resumption(localize));
        off_m[estimate] = rms(day.final, source.truth, world());
        EXPECT_TRUE(!estimate || day.map.size() <= firstDay().map.size() + (use_ids ? 0u : 2u));
        for (const Block& block : day.saved.state.blocks)
          EXPECT_EQ(block.block_kind, BlockKind::kPoint);
      }
      EXPECT_LT(off_m[true], 0.7 * off_m[false]) << use_ids << localize;
    }
  }
}

TEST_F(ReadingMaps, TakeInWhatWasNotInThem) {
  RingOfPosts half = ring(4, 0, RingOfPosts::kSteps / 2);
  const Day first = drive(half, {});
  ASSERT_LT(first.map.size(), static_cast<std::size_t>(RingOfPosts::kPosts));
  Resumption from;
  from.map = first.saved;
  from.localize = true;
  RingOfPosts again = ring(5, 0, RingOfPosts::kSteps);
  const Day fixed = drive(again, {}, from);
  EXPECT_EQ(fixed.map.size(), first.map.size());
  EXPECT_GT(fixed.refused.at("no landmark of the map"), 100u);
  from.localize = false;
  RingOfPosts third = ring(5, 0, RingOfPosts::kSteps);
  const Day grown = drive(third, {}, from);
  EXPECT_EQ(grown.map.size(), static_cast<std::size_t>(RingOfPosts::kPosts));
  EXPECT_EQ(grown.saved.identities.size(), grown.map.size());
  EXPECT_LT(rmsOfPosts(grown.map), 0.2);
}

TEST_F(ReadingMaps, WhatOneWrongReadingFoundedStaysAsUnsureAsItIs) {
  RingOfPosts source = ring(12);
  source.ghost_at = 30;
  RangeBearingOptions options;
  options.known_gate_probability = 0.9;
  const Day day = drive(source, options, resumption(false));
  ASSERT_EQ(day.map.size(), firstDay().map.size() + 1);
  for (const LandmarkRecord& landmark : day.map) EXPECT_LT(landmark.covariance.trace(), 1.0);
}

TEST_F(ReadingMaps, ARobotThatIsElsewhereFindsBackByKnownIdentities) {
  RingOfPosts source = ring(6);
  Resumption from = resumption(true);
  from.T_world_robot = from.T_world_robot * Pose2{1.0, -0.8, radians(40.0)};
  RangeBearingSession session({}, {}, {}, from);
  session.run(source, [](const auto&...) { return true; });
  const Pose2 truth = planarPart(source.truth.back().T_world_body);
  EXPECT_LT(
      (session.estimator().pose().translation() - transform(world(), truth.translation())).norm(),
      0.15);
  expectSamePlaces(session.savedMap(), firstDay().saved);
}

TEST_F(ReadingMaps, ARobotAnywhereFindsWhereItIsByKnownIdentities) {
  for (const bool localize : {true, false}) {
    RingOfPosts source = ring(7);
    Resumption from;
    from.map = firstDay().saved;
    from.localize = localize;
    from.anywhere = PlaceOptions{};
    const Day day = drive(source, {}, from);
    EXPECT_LE(day.placed_after, 5);
    EXPECT_LT(rms(day.final, source.truth, world()), 0.06);
    EXPECT_EQ(day.map.size(), firstDay().map.size());
    if (localize) expectSamePlaces(day.saved, firstDay().saved);
  }
}

TEST_F(ReadingMaps, ARobotAnywhereMayWaitForItsFirstLandmark) {
  for (const bool wait : {false, true}) {
    RangeBearingOptions options;
    options.wait_for_landmark = wait;
    RingOfPosts source = ring(7);
    source.blind = 15;
    Resumption from;
    from.map = firstDay().saved;
    from.localize = true;
    from.anywhere = PlaceOptions{};
    const Day day = drive(source, options, from);
    ASSERT_GT(day.placed_after, 14);
    const auto at = static_cast<std::size_t>(day.placed_after);
    const Eigen::Vector2d p = day.online[at].T_world_body.translation().head<2>();
    const Eigen::Vector2d truth = source.truth[at].T_world_body.translation().head<2>();
    EXPECT_LT((p - transform(world(), truth)).norm(), 0.15) << wait;
    EXPECT_EQ(day.final.size(), source.truth.size());
  }
}

TEST_F(ReadingMaps, AWrongStartIsSaid) {
  RangeBearingOptions options;
  options.use_ids = false;
  RingOfPosts source = ring(9, 20, 100);
  Resumption from;
  from.map = firstDay().saved;
  from.localize = true;
  from.T_world_robot = {40.0, 40.0, 1.0};
  RangeBearingSession session(options, {}, {}, from);
  session.run(source, [](const auto&...) { return true; });
  ASSERT_FALSE(session.notes().empty());
  EXPECT_NE(session.notes().front().find("is the start right"), std::string::npos);

  RingOfPosts right = ring(9);
  RangeBearingSession known({}, {}, {}, resumption(true));
  known.run(right, [](const auto&...) { return true; });
  EXPECT_TRUE(known.notes().empty());
}

TEST_F(ReadingMaps, ARingOfPostsLooksTheSameFromEverywhere) {
  RangeBearingOptions options;
  options.use_ids = false;
  RingOfPosts source = ring(8);
  Resumption from;
  from.map = firstDay().saved;
  from.anywhere = PlaceOptions{};
  const Day day = drive(source, options, from);
  EXPECT_EQ(day.placed_after, -1);
  EXPECT_GE(day.map.size(), firstDay().map.size());  // of its own
}

/// UTIAS MRCLAM data set 7: five robots among the same posts, each from a start of its own.
TEST_F(ReadingMaps, RealRobotsFindTheirPlaceInEachOthersMaps) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  const auto log = [&](int robot) {
    MrclamImportOptions import;
    import.folder = data;
    import.robot = robot;
    import.log = folder_ / ("robot" + std::to_string(robot) + ".rawlog");
    if (!std::filesystem::exists(import.log)) importMrclam(import);
    return import.log;
  };
  for (const bool known : {true, false}) {
    RangeBearingOptions options;
    options.use_ids = known;
    RawlogSource first(log(3));
    RangeBearingSession maker(options, {}, {});
    maker.run(first, [](const auto&...) { return true; });
    Resumption from;
    from.map = maker.savedMap();
    from.localize = true;
    from.anywhere = PlaceOptions{};
    for (const int robot : {1, 5}) {
      RawlogSource source(log(robot));
      RangeBearingSession session(options, {}, {}, from);
      Trajectory online;
      session.run(source, [&](const Frame& frame, const StepReport&, const auto& now) {
        if (!now.search()) online.push_back({frame.stamp_s, now.estimator().pose().toIsometry3()});
        return true;
      });
      const Trajectory truth =
          readTum(folder_ / ("robot" + std::to_string(robot) + "_ground_truth.tum"));
      EXPECT_GT(online.size(), 1000u) << robot << known;
      EXPECT_LT(evaluateTrajectory(online, truth).ate_rmse_m, 0.2) << robot << known;
    }
  }
}

TEST_F(ReadingMaps, MadeFromCamerasAreRefused) {
  Resumption from;
  from.map = Mapper({}).savedMap();
  EXPECT_THROW(RangeBearingEstimator({}, {}, from), Error);
  from.map = firstDay().saved;
  from.anywhere = PlaceOptions{};
  EXPECT_THROW(RangeBearingEstimator({}, {}, from), Error);  // a session finds it
}

TEST_F(ReadingMaps, AreSavedAndLoadedByTheFaceOfMrptsFilter) {
  RangeBearingSlam slam;
  slam.options.std_sensor_range = 0.05;
  slam.options.std_sensor_yaw = radians(1.0);
  slam.reset();
  const auto step = [&](const Pose2& T_world_robot) {
    auto scan = mrpt::obs::CObservationBearingRange::Create();
    scan->maxSensorDistance = 100.0F;
    for (int i = 1; i <= RingOfPosts::kPosts; i += 3) {
      const Eigen::Vector2d p = transform(T_world_robot.inverse(), RingOfPosts::post(i));
      mrpt::obs::CObservationBearingRange::TMeasurement reading;
      reading.range = static_cast<float>(p.norm());
      reading.yaw = static_cast<float>(std::atan2(p.y(), p.x()));
      reading.pitch = 0.0F;
      reading.landmarkID = i;
      scan->sensedData.push_back(reading);
    }
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(scan);
    slam.processActionObservation(mrpt::obs::CActionCollection::Create(), frame);
  };
  for (int i = 0; i < 20; ++i) step({});
  slam.saveMap(folder_ / "map.colonnade");
  const SavedMap before = slam.estimator().savedMap();

  MapStart start;
  start.localize = true;
  start.T_world_robot = {0.9, 0.6, radians(10.0)};
  start.covariance = MapStart::startCovariance(0.3, radians(10.0));
  slam.loadMap(folder_ / "map.colonnade", start);
  for (int i = 0; i < 20; ++i) step({1.0, 0.5, radians(20.0)});
  mrpt::poses::CPosePDFGaussian pose;
  slam.getCurrentRobotPose(pose);
  EXPECT_NEAR(pose.mean.x(), 1.0, 0.05);
  EXPECT_NEAR(pose.mean.y(), 0.5, 0.05);
  EXPECT_NEAR(pose.mean.phi(), radians(20.0), radians(2.0));
  expectSamePlaces(slam.estimator().savedMap(), before);
  slam.reset();
  EXPECT_TRUE(slam.estimator().map().empty());
  EXPECT_THROW(slam.loadMap(folder_ / "none"), Error);
}

}  // namespace
}  // namespace colonnade
