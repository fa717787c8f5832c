// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/association.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

Detection seen(const Pose2& T_world_robot, const Eigen::Vector2d& p_world, bool with_range = true,
               LandmarkKind kind = LandmarkKind::kPillarEdge) {
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
  d.appearance.left = Eigen::Vector3f::Constant(60.0F);
  d.appearance.right = Eigen::Vector3f::Constant(180.0F);
  return d;
}

/// Pillars seen well from the origin, then a robot that is unsure where it is.
class AssociationTest : public ::testing::Test {
 protected:
  void learn(const std::vector<Eigen::Vector2d>& pillars, int times = 20) {
    for (int i = 0; i < times; ++i)
      for (std::size_t k = 0; k < pillars.size(); ++k) {
        const Detection detection = seen({}, pillars[k]);
        if (i == 0) ids_.push_back(*filter_.addLandmark(detection.measurement));
        const Match match{ids_[k], detection.measurement};
        if (i > 0) filter_.update({&match, 1});
        book_.observe(ids_[k], detection, 0.1 * i, filter_);
      }
  }
  void becomeUnsure(double x_m, double y_m, double turn) {
    filter_.predict({}, Eigen::Vector3d(x_m * x_m, y_m * y_m, turn * turn).asDiagonal());
  }
  Association match(const Detections& detections, const AssociationOptions& options) const {
    return Associator(options).match(detections, filter_, book_);
  }
  /// Detections matched to the pillar they are of, given which pillar each one shows (-1: none).
  static int right(const Association& association, const std::vector<LandmarkId>& ids,
                   const std::vector<int>& truth) {
    int count = 0;
    for (std::size_t i = 0; i < association.matches.size(); ++i) {
      const int pillar = truth[association.detection_of_match[i]];
      count +=
          pillar >= 0 && association.matches[i].landmark == ids[static_cast<std::size_t>(pillar)];
    }
    return count;
  }

  EkfSlam filter_{FilterOptions{}};
  LandmarkBook book_;
  std::vector<LandmarkId> ids_;
};

AssociationOptions nearest() {
  AssociationOptions options;
  options.method = "nearest";
  options.consensus_matches = 0;
  return options;
}
AssociationOptions jcbb() {
  AssociationOptions options = nearest();
  options.method = "jcbb";
  return options;
}
AssociationOptions consensus() {
  AssociationOptions options = nearest();
  options.consensus_matches = 4;
  return options;
}

TEST_F(AssociationTest, ACombOfPillarsShiftedByNearlyOneGapIsMatchedAsAWhole) {
  std::vector<Eigen::Vector2d> comb;
  for (int i = 0; i < 7; ++i) comb.emplace_back(3.0, -1.2 + 0.4 * i);
  learn(comb);
  becomeUnsure(0.02, 0.25, radians(0.5));
  // The robot stands 0.25 m to the side: to every pillar the neighbour is nearer than itself.
  Detections detections;
  std::vector<int> truth;
  for (std::size_t k = 0; k < comb.size(); ++k) {
    detections.push_back(seen({0.0, 0.25, 0.0}, comb[k]));
    truth.push_back(static_cast<int>(k));
  }
  EXPECT_EQ(0, right(match(detections, nearest()), ids_, truth));
  EXPECT_EQ(7, right(match(detections, jcbb()), ids_, truth));
}

TEST_F(AssociationTest, AShiftThatFitsEachPillarAloneButNotTheirSpacingIsRefused) {
  const std::vector<Eigen::Vector2d> comb = {{3.0, -1.0}, {3.0, -0.6}, {3.0, -0.1}, {3.0, 0.5}};
  learn(comb);
  becomeUnsure(0.02, 0.3, radians(0.5));
  // Other pillars, each well within the gate of its neighbour, in another rhythm.
  const std::vector<double> shifts = {0.45, 0.25, 0.40, 0.20};
  Detections detections;
  for (std::size_t k = 0; k < comb.size(); ++k)
    detections.push_back(seen({}, comb[k] + Eigen::Vector2d(0.0, shifts[k]), false));
  for (std::size_t k = 0; k < comb.size(); ++k)
    EXPECT_TRUE(filter_.innovation(ids_[k], detections[k].measurement)->within_gate);
  const Association joint = match(detections, jcbb());
  EXPECT_LT(joint.matches.size(), 3u);
  EXPECT_GT(joint.refused.at("joint test"), 0u);
}

TEST_F(AssociationTest, ALoneBearingAtTheRimOfAWideGateMayBeOfSomethingElse) {
  learn({{3.0, 0.0}});
  becomeUnsure(0.1, 0.1, radians(4.0));
  const auto off = [&](double turn) {
    return match({seen({0.0, 0.0, turn}, {3.0, 0.0}, false)}, jcbb());
  };
  EXPECT_EQ(1u, off(radians(3.0)).matches.size());
  const Association at_the_rim = off(radians(10.0));
  EXPECT_TRUE(at_the_rim.matches.empty());
  EXPECT_EQ(1u, at_the_rim.refused.at("as likely something else"));
  EXPECT_TRUE(at_the_rim.near_landmark.front());
  AssociationOptions no_clutter = jcbb();
  no_clutter.clutter = 0.0;
  EXPECT_EQ(1u,
            match({seen({0.0, 0.0, radians(10.0)}, {3.0, 0.0}, false)}, no_clutter).matches.size());
}

TEST_F(AssociationTest, TheMoreIsInViewThatNothingExplainsTheLessALoneBearingSays) {
  learn({{3.0, 0.0}});
  becomeUnsure(0.1, 0.1, radians(4.0));
  Detections detections{seen({0.0, 0.0, radians(6.0)}, {3.0, 0.0}, false)};
  EXPECT_EQ(1u, match(detections, jcbb()).matches.size());
  for (int i = 0; i < 8; ++i)  // 60 degrees away
    detections.push_back(seen({}, {2.0, 3.5 + 0.1 * i}, false));
  EXPECT_TRUE(match(detections, jcbb()).matches.empty());
}

TEST_F(AssociationTest, BearingsThatAreOffAlikeBearEachOtherOut) {
  const std::vector<Eigen::Vector2d> pillars = {{3.0, -0.9}, {3.2, -0.1}, {2.8, 0.8}};
  learn(pillars);
  becomeUnsure(0.1, 0.1, radians(4.0));
  Detections detections;
  for (const auto& pillar : pillars)
    detections.push_back(seen({0.0, 0.0, radians(9.0)}, pillar, false));
  EXPECT_EQ(3, right(match(detections, jcbb()), ids_, {0, 1, 2}));
}

TEST_F(AssociationTest, ThirtyPercentOutliersAreSetAside) {
  std::vector<Eigen::Vector2d> pillars;
  for (int i = 0; i < 14; ++i) {
    const double bearing = radians(-33.0 + 5.0 * i);
    const double distance = 2.0 + 0.9 * ((i * 5) % 4);
    pillars.emplace_back(distance * std::cos(bearing), distance * std::sin(bearing));
  }
  learn(pillars);
  const double turn = radians(2.5);
  becomeUnsure(0.03, 0.03, turn);
  const auto rightAndWrong = [&](const AssociationOptions& options) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> anywhere(-radians(36.0), radians(36.0));
    std::normal_distribution<double> normal;
    std::pair<double, double> counts(0.0, 0.0);
    for (int round = 0; round < 30; ++round) {
      const Pose2 truth_pose{0.03 * normal(generator), 0.03 * normal(generator),
                             turn * normal(generator)};
      Detections detections;
      std::vector<int> truth;
      for (std::size_t k = 0; k < pillars.size(); ++k) {
        detections.push_back(seen(truth_pose, pillars[k], false));
        detections.back().measurement.z(0) += radians(0.3) * normal(generator);
        truth.push_back(static_cast<int>(k));
      }
      for (int i = 0; i < 6; ++i) {  // of 20
        detections.push_back(detections.front());
        detections.back().measurement.z(0) = anywhere(generator);
        truth.push_back(-1);
      }
      const Association association = match(detections, options);
      const int good = right(association, ids_, truth);
      counts.first += good / 420.0;
      counts.second += (static_cast<int>(association.matches.size()) - good) / 420.0;
    }
    return counts;
  };
  const auto [nearest_right, nearest_wrong] = rightAndWrong(nearest());
  const auto [joint_right, joint_wrong] = rightAndWrong(jcbb());
  const auto [consensus_right, consensus_wrong] = rightAndWrong(consensus());
  std::cout << "right, wrong: nearest " << nearest_right << ", " << nearest_wrong << "; jcbb "
            << joint_right << ", " << joint_wrong << "; consensus " << consensus_right << ", "
            << consensus_wrong << "\n";
  EXPECT_GT(joint_right, 0.7);
  EXPECT_LT(joint_wrong, 0.2);
  EXPECT_GT(consensus_right, 0.8);
  EXPECT_LT(consensus_wrong, 0.12);
  EXPECT_GT(joint_right, nearest_right);
}

TEST_F(AssociationTest, OnePointConsensusDropsWhatAgreesWithNoOther) {
  const std::vector<Eigen::Vector2d> pillars = {{2.0, 1.0},  {2.5, -1.0}, {3.0, 0.4},
                                                {3.5, -0.5}, {4.0, 1.5},  {4.2, 0.0}};
  learn(pillars);
  becomeUnsure(0.02, 0.02, radians(4.0));
  const Pose2 turned{0.0, 0.0, radians(5.0)};
  Detections detections;
  for (const auto& pillar : pillars) detections.push_back(seen(turned, pillar, false));
  detections[2].measurement.z(0) += radians(6.0);  // fits alone, as a turn the other way
  ASSERT_TRUE(filter_.innovation(ids_[2], detections[2].measurement)->within_gate);
  const Association association = match(detections, consensus());
  EXPECT_EQ(5u, association.matches.size());
  EXPECT_EQ(1u, association.refused.at("one-point consensus"));
}

TEST_F(AssociationTest, ColoursTellTwoEdgesApartThatStandAtOnePlace) {
  learn({{3.0, 0.0}});
  Detection other = seen({}, {3.0, 0.0});
  other.appearance.left = Eigen::Vector3f(200.0F, 60.0F, 10.0F);
  other.appearance.right = Eigen::Vector3f(10.0F, 60.0F, 250.0F);
  const Association refused = match({other}, jcbb());
  EXPECT_TRUE(refused.matches.empty());
  EXPECT_EQ(1u, refused.refused.at("looks unlike the landmark"));
  // Another background is no reason: it changes with the place it is seen from.
  other.appearance.left = Eigen::Vector3f::Constant(70.0F);
  EXPECT_EQ(1u, match({other}, jcbb()).matches.size());
  // Nor is anything when looks are not asked for.
  AssociationOptions blind = jcbb();
  blind.looks_probability = 1.0;
  other.appearance.left = Eigen::Vector3f(200.0F, 60.0F, 10.0F);
  EXPECT_EQ(1u, match({other}, blind).matches.size());
}

TEST_F(AssociationTest, OfTwoCandidatesAtOnePlaceTheOneThatLooksAlikeIsTaken) {
  learn({{3.0, 0.0}});
  Detection alike = seen({}, {3.0, 0.02});
  Detection nearer = seen({}, {3.0, 0.0});
  nearer.appearance.left = Eigen::Vector3f::Constant(110.0F);
  nearer.appearance.right = Eigen::Vector3f::Constant(130.0F);
  for (const auto& options : {nearest(), jcbb()}) {
    const Association association = match({nearer, alike}, options);
    ASSERT_EQ(1u, association.matches.size());
    EXPECT_EQ(1u, association.detection_of_match[0]);
  }
}

TEST_F(AssociationTest, EachKindHasItsOwnGate) {
  learn({{3.0, 0.0}});
  Detection off = seen({}, {3.0, 0.0});
  off.measurement.z(0) += 2.0 * std::sqrt(filter_.innovation(ids_[0], off.measurement)->S(0, 0));
  EXPECT_EQ(1u, match({off}, jcbb()).matches.size());
  AssociationOptions narrow = jcbb();
  narrow.pillar_probability = 0.8;
  const Association association = match({off}, narrow);
  EXPECT_TRUE(association.matches.empty());
  EXPECT_TRUE(association.near_landmark[0]);
  EXPECT_EQ(1u, association.refused.at("near a landmark, outside its gate"));
  narrow.pillar_probability = 0.99;
  narrow.floor_edge_probability = narrow.depth_slope_probability = 0.8;
  EXPECT_EQ(1u, match({off}, narrow).matches.size());
}

/// A floor edge across the way, `distance_m` ahead; +1: brighter beyond it.
Detection edgeAhead(double distance_m, int gradient_sign) {
  Detection d;
  d.measurement.kind = LandmarkKind::kFloorEdge;
  d.measurement.z.resize(2);
  d.measurement.z << 0.0, distance_m;
  d.measurement.R = Eigen::Vector2d(radians(0.5), 0.02).cwiseAbs2().asDiagonal();
  d.p_robot_a = {distance_m, 1.0};
  d.p_robot_b = {distance_m, -1.0};
  d.appearance.gradient_sign = gradient_sign;
  d.appearance.left = Eigen::Vector3f::Constant(gradient_sign < 0 ? 180.0F : 60.0F);
  d.appearance.right = Eigen::Vector3f::Constant(gradient_sign < 0 ? 60.0F : 180.0F);
  return d;
}

/// A floor edge 2 m ahead, seen ten times, then the robot beyond it, 0.2 m unsure, looking back.
class FloorEdgeFromBothSides : public AssociationTest {
 protected:
  void learnAndPass(const std::vector<int>& gradient_signs) {
    for (std::size_t i = 0; i < gradient_signs.size(); ++i) {
      const Detection detection = edgeAhead(2.0, gradient_signs[i]);
      if (i == 0) ids_.push_back(*filter_.addLandmark(detection.measurement));
      const Match match{ids_[0], detection.measurement};
      if (i > 0) filter_.update({&match, 1});
      book_.observe(ids_[0], detection, 0.1 * static_cast<double>(i), filter_);
    }
    filter_.predict({3.0, 0.0, kPi}, Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal());
  }
};

TEST_F(FloorEdgeFromBothSides, ALineOnTheFloorIsKnownAgain) {
  learnAndPass({-1, -1, -1, -1, -1});
  const Association association = match({edgeAhead(0.95, 1)}, jcbb());
  ASSERT_EQ(1u, association.matches.size());
  EXPECT_EQ(ids_[0], association.matches[0].landmark);
}

TEST_F(FloorEdgeFromBothSides, TheFootOnTheOtherSideOfAWallIsAnother) {
  // From either side the skirting is the dark one, and beyond.
  learnAndPass({-1, -1, -1, -1, -1});
  const Association association = match({edgeAhead(0.76, -1)}, jcbb());
  EXPECT_TRUE(association.matches.empty());
  EXPECT_FALSE(association.near_landmark[0]);  // it may found one
}

TEST_F(FloorEdgeFromBothSides, LandmarksFoundedFromOppositeSidesAreComparedInOneWay) {
  learnAndPass({-1, -1, -1});
  const auto founded = [&](int gradient_sign) {
    const Detection detection = edgeAhead(1.0, gradient_sign);
    const LandmarkId id = *filter_.addLandmark(detection.measurement);
    for (int i = 0; i < 3; ++i) book_.observe(id, detection, 1.0, filter_);
    return id;
  };
  const LandmarkId line = founded(1), foot = founded(-1);
  EXPECT_TRUE(book_.lookAlike(ids_[0], line, filter_.state()));
  EXPECT_FALSE(book_.lookAlike(ids_[0], foot, filter_.state()));
  EXPECT_TRUE(book_.lookAlike(foot, foot, filter_.state()));
  EXPECT_LT(*book_.colourDistance(ids_[0], line, filter_.state()),
            *book_.colourDistance(ids_[0], foot, filter_.state()));
  book_.merge(ids_[0], line, filter_.state());
  EXPECT_TRUE(book_.looks(ids_[0])->hasDarkSide());
  EXPECT_EQ(6, book_.looks(ids_[0])->sightings());
}

TEST_F(FloorEdgeFromBothSides, AThinLineHasNoDarkSide) {
  learnAndPass({-1, 1, -1, 1, -1, 1});
  EXPECT_EQ(1u, match({edgeAhead(0.95, 1)}, jcbb()).matches.size());
  EXPECT_EQ(1u, match({edgeAhead(0.95, -1)}, jcbb()).matches.size());
}

TEST_F(FloorEdgeFromBothSides, SightingsFromEitherSideAddUp) {
  learnAndPass({-1, -1, -1});
  for (int i = 0; i < 20; ++i) book_.observe(ids_[0], edgeAhead(1.0, 1), 1.0, filter_);
  EXPECT_TRUE(book_.looks(ids_[0])->hasDarkSide());
  EXPECT_EQ(1u, match({edgeAhead(0.95, 1)}, jcbb()).matches.size());
}

TEST_F(AssociationTest, TheSearchIsBounded) {
  std::vector<Eigen::Vector2d> crowd;
  for (int i = 0; i < 30; ++i) crowd.emplace_back(3.0 + 0.01 * i, 0.02 * i);
  learn(crowd, 2);
  becomeUnsure(0.3, 0.3, radians(8.0));
  Detections detections;
  for (const auto& pillar : crowd) detections.push_back(seen({0.1, -0.2, 0.0}, pillar, false));
  AssociationOptions options = jcbb();
  options.joint_nodes = 1000;
  EXPECT_FALSE(match(detections, options).matches.empty());  // and comes back at all
}

TEST_F(AssociationTest, NothingIsMatchedWithoutLandmarksOrByNumbersThatAreNotFinite) {
  Detection broken = seen({}, {3.0, 0.0});
  EXPECT_TRUE(match({broken}, jcbb()).matches.empty());
  learn({{3.0, 0.0}});
  broken.measurement.z(0) = std::nan("");
  EXPECT_TRUE(match({broken}, jcbb()).matches.empty());
  EXPECT_TRUE(match({}, jcbb()).matches.empty());
}

/// The line y = `y_m` on the floor, seen from the origin.
Detection floorLine(double y_m, bool joint) {
  Detection d;
  d.measurement.kind = LandmarkKind::kFloorEdge;
  d.measurement.z = Eigen::Vector2d(0.5 * kPi, y_m);
  d.measurement.R = Eigen::Vector2d(1e-4, 1e-4).asDiagonal();
  d.p_robot_a = {1.0, y_m};
  d.p_robot_b = {2.0, y_m};
  d.on_surface = joint;
  return d;
}

TEST_F(AssociationTest, AJointOfTheFloorIsNoFootOfAWall) {
  const auto learnLine = [&](double y_m, int as_joint, int as_foot) {
    const LandmarkId id = *filter_.addLandmark(floorLine(y_m, false).measurement);
    for (int i = 0; i < as_joint + as_foot; ++i)
      book_.observe(id, floorLine(y_m, i < as_joint), 0.1 * i, filter_);
    return id;
  };
  const LandmarkId joint = learnLine(1.0, 10, 1), foot = learnLine(3.0, 1, 10);
  const LandmarkId either = learnLine(5.0, 5, 6);
  EXPECT_TRUE(book_.isJoint(joint));
  EXPECT_FALSE(book_.isJoint(foot));
  EXPECT_FALSE(book_.isJoint(either));
  const auto matched = [&](double y_m, bool as_joint) {
    return match({floorLine(y_m, as_joint)}, jcbb()).matches.size();
  };
  EXPECT_EQ(1U, matched(1.0, true));
  EXPECT_EQ(0U, matched(1.0, false));
  EXPECT_EQ(0U, matched(3.0, true));
  EXPECT_EQ(1U, matched(3.0, false));
  EXPECT_EQ(1U, matched(5.0, true));  // now seen as the one, now as the other
  EXPECT_EQ(1U, matched(5.0, false));
}

}  // namespace
}  // namespace colonnade
