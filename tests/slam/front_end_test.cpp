// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "colonnade/base/angle.hpp"
#include "colonnade/slam/association.hpp"
#include "colonnade/slam/axis_tracker.hpp"
#include "colonnade/slam/floor_directions.hpp"
#include "colonnade/slam/initializer.hpp"

namespace colonnade {
namespace {

/// A corner or a pillar edge as a detector would report it from this pose, without noise.
Detection seen(const Pose2& T_world_robot, const Eigen::Vector2d& p_world, LandmarkKind kind,
               bool with_range = true) {
  const Eigen::Vector2d p = transform(T_world_robot.inverse(), p_world);
  Detection d;
  d.measurement.kind = kind;
  d.measurement.z.resize(with_range ? 2 : 1);
  d.measurement.R.setZero(d.measurement.z.size(), d.measurement.z.size());
  d.measurement.z(0) = std::atan2(p.y(), p.x());
  d.measurement.R(0, 0) = radians(0.3) * radians(0.3);
  if (with_range) {
    d.measurement.z(1) = p.norm();
    d.measurement.R(1, 1) = 0.03 * 0.03;
  }
  d.appearance.gradient_sign = 1;
  return d;
}

const Eigen::Matrix3d kStepNoise =
    Eigen::Vector3d(1e-4, 1e-4, radians(0.5) * radians(0.5)).asDiagonal();

class FrontEnd : public ::testing::Test {
 protected:
  /// One pass of association, update and initialisation.
  Association step(const Detections& detections) {
    Frame frame;
    frame.index = index_++;
    frame.stamp_s = 0.1 * static_cast<double>(frame.index);
    const auto association = associator_.match(detections, filter_, book_);
    const auto used = filter_.update(association.matches);
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i])
        book_.observe(association.matches[i].landmark,
                      detections[association.detection_of_match[i]], frame.stamp_s, filter_);
    initializer_.step(frame, detections, association, filter_, book_, events_);
    return association;
  }
  void drive(const Pose2& u) { filter_.predict(u, kStepNoise); }
  std::size_t landmarks() const { return filter_.landmarkMap().size(); }

  EkfSlam filter_{FilterOptions{}};
  LandmarkBook book_;
  Associator associator_{AssociationOptions{}};
  Initializer initializer_{InitializationOptions{}};
  std::vector<Event> events_;
  std::size_t index_ = 0;
};

TEST_F(FrontEnd, AThingSeenThreeTimesBecomesOneLandmarkAndASpeckleDoesNot) {
  const Eigen::Vector2d corner(2.0, 0.5);
  step({seen(filter_.pose(), corner, LandmarkKind::kDepthSlope),
        seen(filter_.pose(), {3.0, -1.0}, LandmarkKind::kDepthSlope)});
  step({seen(filter_.pose(), corner, LandmarkKind::kDepthSlope)});
  EXPECT_EQ(0u, landmarks());
  for (int i = 0; i < 10; ++i) step({seen(filter_.pose(), corner, LandmarkKind::kDepthSlope)});
  ASSERT_EQ(1u, landmarks());
  EXPECT_LT((filter_.landmarkMap()[0].p_world - corner).norm(), 1e-6);
  EXPECT_EQ(10, filter_.landmarkMap()[0].observations);  // from its birth on
}

TEST_F(FrontEnd, ALandmarkHardlySeenIsPurgedWithoutATrace) {
  const auto before = filter_.state().P;
  for (int i = 0; i < 4; ++i) step({seen(filter_.pose(), {2.0, 0.5}, LandmarkKind::kDepthSlope)});
  ASSERT_EQ(1u, landmarks());
  for (int i = 0; i < 40; ++i) step({});
  EXPECT_EQ(0u, landmarks());
  EXPECT_EQ("purged", events_.back().what);
  EXPECT_EQ(before.rows(), filter_.state().P.rows());
}

TEST_F(FrontEnd, BearingsBecomeALandmarkOnlyOnceTheRobotHasMoved) {
  const Eigen::Vector2d edge(3.0, 1.0);
  for (int i = 0; i < 10; ++i) step({seen(filter_.pose(), edge, LandmarkKind::kPillarEdge, false)});
  EXPECT_EQ(0u, landmarks());
  for (int i = 0; i < 20; ++i) {
    drive({0.05, 0.0, 0.0});
    step({seen(filter_.pose(), edge, LandmarkKind::kPillarEdge, false)});
  }
  ASSERT_EQ(1u, landmarks());
  EXPECT_LT((filter_.landmarkMap()[0].p_world - edge).norm(), 0.02);
  for (const Block& block : filter_.state().blocks)
    EXPECT_NE(BlockKind::kPoseClone, block.block_kind);
}

TEST_F(FrontEnd, ABearingCandidateThatVanishesLeavesTheStateAsItWas) {
  step({seen(filter_.pose(), {3.0, 1.0}, LandmarkKind::kPillarEdge, false)});
  EXPECT_EQ(6, filter_.state().x.size());
  for (int i = 0; i < 10; ++i) step({});
  EXPECT_EQ(3, filter_.state().x.size());
}

TEST_F(FrontEnd, MatchesThatOnlyFitAloneAreRefusedTogether) {
  // Two corners known exactly relative to each other; afterwards the heading is uncertain.
  const Eigen::Vector2d left(2.0, 0.6);
  const Eigen::Vector2d right(2.0, -0.6);
  for (int i = 0; i < 30; ++i)
    step({seen(filter_.pose(), left, LandmarkKind::kDepthSlope),
          seen(filter_.pose(), right, LandmarkKind::kDepthSlope)});
  filter_.predict({}, Eigen::Vector3d(1e-6, 1e-6, radians(6.0) * radians(6.0)).asDiagonal());
  // Both shifted outwards by what the heading could explain for one of them, but not for both.
  Detection a = seen(filter_.pose(), left, LandmarkKind::kDepthSlope);
  Detection b = seen(filter_.pose(), right, LandmarkKind::kDepthSlope);
  a.measurement.z(0) += radians(10.0);
  b.measurement.z(0) -= radians(10.0);
  const auto association = associator_.match({a, b}, filter_, book_);
  EXPECT_EQ(1u, association.matches.size());
  EXPECT_EQ(1u, association.refused.at("joint test"));
  // Shifted the same way they fit.
  b.measurement.z(0) += radians(20.0);
  EXPECT_EQ(2u, associator_.match({a, b}, filter_, book_).matches.size());
}

TEST_F(FrontEnd, AnEdgeWithItsDarkSideOnTheOtherHandIsAnotherEdge) {
  const Eigen::Vector2d edge(2.0, 0.0);
  for (int i = 0; i < 6; ++i) step({seen(filter_.pose(), edge, LandmarkKind::kPillarEdge)});
  Detection other = seen(filter_.pose(), edge, LandmarkKind::kPillarEdge);
  other.appearance.gradient_sign = -1;
  EXPECT_TRUE(associator_.match({other}, filter_, book_).matches.empty());
  for (int i = 0; i < 6; ++i) step({other});
  EXPECT_EQ(2u, landmarks());
  EXPECT_EQ(
      1u, associator_.match({seen(filter_.pose(), edge, LandmarkKind::kPillarEdge)}, filter_, book_)
              .matches.size());
}

TEST_F(FrontEnd, PairsAreWhatIsSeenTogetherOften) {
  const Eigen::Vector2d left(2.0, 0.15);
  const Eigen::Vector2d right(2.0, -0.15);
  for (int i = 0; i < 8; ++i) {
    const auto a = step({seen(filter_.pose(), left, LandmarkKind::kPillarEdge),
                         seen(filter_.pose(), right, LandmarkKind::kPillarEdge)});
    if (a.matches.size() == 2) book_.observePair(a.matches[0].landmark, a.matches[1].landmark);
  }
  LandmarkMap map = filter_.landmarkMap();
  book_.fillPairs(map);
  ASSERT_EQ(2u, map.size());
  EXPECT_EQ(map[1].id, map[0].pair_id);
  EXPECT_EQ(map[0].id, map[1].pair_id);
}

TEST(AxisTracker, WallsHoldTheHeadingAndObliqueOnesFoundTheirOwnAxis) {
  EkfSlam filter{FilterOptions{}};
  AxisTracker tracker{AxisOptions{}};
  std::vector<Event> events;
  Frame frame;
  WallDirection wall;
  wall.sigma = radians(0.5);
  wall.length_m = 2.0;
  for (int i = 0; i < 200; ++i) {
    filter.predict({0.05, 0.0, 0.0}, kStepNoise);
    wall.direction = wrapQuarterTurn(radians(20.0));
    tracker.step(frame, {wall}, 1.0, filter, events);
  }
  ASSERT_EQ(1u, tracker.axes().size());
  EXPECT_LT(std::sqrt(filter.poseCovariance()(2, 2)), radians(2.0));
  wall.direction = wrapQuarterTurn(radians(50.0));
  for (int i = 0; i < 10; ++i) tracker.step(frame, {wall}, 1.0, filter, events);
  EXPECT_EQ(2u, tracker.axes().size());
}

TEST(FloorDirections, FloorEdgesTellTheDirectionsOfWallsLongestFirst) {
  Detection edge;
  edge.measurement.kind = LandmarkKind::kFloorEdge;
  edge.measurement.z = Eigen::Vector2d(radians(100.0), 1.0);
  edge.measurement.R = Eigen::Vector2d(radians(0.5) * radians(0.5), 1e-4).asDiagonal();
  edge.p_robot_b = Eigen::Vector2d(2.0, 0.0);
  Detection longer = edge;
  longer.measurement.z(0) = radians(-85.0);
  longer.p_robot_b = Eigen::Vector2d(3.0, 0.0);
  Detection refused = edge;
  refused.refusal = "above the floor";
  Detection broken = edge;
  broken.measurement.z(0) = std::nan("");
  const Detection pillar = seen({}, {2.0, 0.0}, LandmarkKind::kPillarEdge, false);
  const auto walls = floorEdgeDirections({edge, longer, refused, broken, pillar});
  ASSERT_EQ(2u, walls.size());
  EXPECT_NEAR(radians(5.0), walls[0].direction, 1e-9);
  EXPECT_NEAR(radians(10.0), walls[1].direction, 1e-9);
  EXPECT_NEAR(radians(0.5), walls[1].sigma, 1e-9);
  EXPECT_NEAR(2.0, walls[1].length_m, 1e-9);
}

}  // namespace
}  // namespace colonnade
