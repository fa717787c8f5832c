// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include "bearing_drive.hpp"

namespace colonnade {
namespace {

const std::vector<Eigen::Vector2d> kPillars = {{3.6, 1.2}, {4.5, -1.3},  {6.2, 1.7},  {7.7, -1.8},
                                               {9.5, 1.3}, {11.0, -1.5}, {12.6, 1.6}, {14.4, -1.4}};

class Initialization : public ::testing::TestWithParam<const char*> {
 protected:
  static InitializationOptions options() {
    InitializationOptions options;
    options.policy = GetParam();
    return options;
  }
  static BearingDrive drive(BearingDrive::Noise noise, unsigned seed) {
    return {options(), {}, noise, seed};
  }
  bool isUndelayed() const { return std::string(GetParam()) == "undelayed"; }
};

Measurement bearingTo(const Pose2& T_world_robot, const Eigen::Vector2d& p_world) {
  const Eigen::Vector2d p = transform(T_world_robot.inverse(), p_world);
  Measurement m;
  m.z.resize(1);
  m.z << std::atan2(p.y(), p.x());
  m.R.resize(1, 1);
  m.R << radians(0.3) * radians(0.3);
  return m;
}

TEST_P(Initialization, AStandingRobotFoundsNothing) {
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 40; ++i) robot.step({}, {{3.0, 1.0}});
  EXPECT_TRUE(robot.filter().landmarkMap().empty());
}

TEST_P(Initialization, AMovingRobotFoundsThePillarWhereItStandsAndOnlyOnce) {
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 25; ++i) robot.step({0.1, 0.0, 0.0}, {{4.0, 1.2}});
  const LandmarkMap map = robot.filter().landmarkMap();
  ASSERT_EQ(1u, map.size());
  EXPECT_LT((map[0].p_world - Eigen::Vector2d(4.0, 1.2)).norm(), 0.05);
  EXPECT_EQ(1u, robot.filter().state().blocks.size()) << "something is left of the candidate";
}

TEST_P(Initialization, ASpeckleFoundsNothing) {
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 4; ++i) robot.step({0.1, 0.0, 0.0}, {{4.0, 1.2}});
  for (int i = 0; i < 8; ++i) robot.step({0.1, 0.0, 0.0}, {});
  EXPECT_TRUE(robot.filter().state().blocks.empty());
  EXPECT_TRUE(robot.filter().landmarkMap().empty());
}

TEST_P(Initialization, AnEdgeThatMovesAgainstEveryDistanceFoundsNothing) {
  // Walking ahead and outwards, it would have to stand behind the camera.
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 60; ++i) {
    robot.step({0.05, 0.0, 0.0}, {});
    robot.process({robot.detection(radians(20.0 - 0.25 * i))});
  }
  for (int i = 0; i < 40; ++i) robot.step({0.05, 0.0, 0.0}, {});
  EXPECT_TRUE(robot.filter().state().blocks.empty());
}

/// A filter that keeps correcting itself by three corners, with or without a candidate in it.
class WithCorners {
 public:
  WithCorners() {
    FilterOptions options;
    options.error_correlation_s = 0.0;
    filter = EkfSlam(options);
    for (const Eigen::Vector2d& corner : kCorners)
      corners.push_back(*filter.addLandmark(seen(corner)));
  }
  void step() {
    filter.predict({0.1, 0.0, radians(1.0)},
                   Eigen::Vector3d(1e-5, 1e-5, radians(0.5) * radians(0.5)).asDiagonal());
    truth = truth * Pose2{0.102, 0.001, radians(0.8)};
    std::vector<Match> matches;
    for (std::size_t i = 0; i < corners.size(); ++i)
      matches.push_back({corners[i], seen(kCorners[i])});
    filter.update(matches);
  }
  EkfSlam filter{FilterOptions{}};
  Pose2 truth;
  std::vector<LandmarkId> corners;

 private:
  Measurement seen(const Eigen::Vector2d& corner) const {
    Measurement m = bearingTo(truth, corner);
    m.kind = LandmarkKind::kDepthSlope;
    m.z = Eigen::Vector2d(m.z(0), transform(truth.inverse(), corner).norm());
    m.R = Eigen::Vector2d(radians(0.5) * radians(0.5), 0.03 * 0.03).asDiagonal();
    return m;
  }
  const std::vector<Eigen::Vector2d> kCorners = {{3.0, 1.0}, {2.5, -1.5}, {5.0, 0.3}};
};

TEST_P(Initialization, ACandidateThatIsDroppedLeavesNoTrace) {
  const Eigen::Vector2d pillar(6.0, 2.0);
  WithCorners with, without;
  PoseClones clones;
  with.step();
  without.step();
  clones.beginFrame();
  const auto place =
      beginInitialization(options(), bearingTo(with.truth, pillar), clones, with.filter);
  const Eigen::Index before = with.filter.state().x.size();
  ASSERT_GT(before, without.filter.state().x.size());
  for (int i = 0; i < 8; ++i) {
    with.step();
    without.step();
    clones.beginFrame();
    place->see({bearingTo(with.truth, pillar), false, 1.0}, with.filter);
  }
  const State candidate = with.filter.state();
  place->leave(with.filter);
  const State& left = with.filter.state();
  const Eigen::Index n = without.filter.state().x.size();
  ASSERT_EQ(n, left.x.size());
  // The corners were there before it, so their marginal is the first part of the state.
  EXPECT_EQ(candidate.x.head(n), left.x);
  EXPECT_EQ(candidate.P.topLeftCorner(n, n), left.P);
  if (isUndelayed()) {
    // Its bearings were used: the robot knows its heading no worse than without them.
    EXPECT_LT(left.P(2, 2), without.filter.state().P(2, 2));
  } else {
    EXPECT_EQ(without.filter.state().x, left.x);
    EXPECT_EQ(without.filter.state().P, left.P);
  }
}

TEST_P(Initialization, HalfMadeLandmarksAreNeitherShownNorMatched) {
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 5; ++i) {
    robot.step({0.01, 0.0, 0.0}, {{8.0, 1.2}});
    EXPECT_TRUE(robot.filter().landmarkMap().empty());
    EXPECT_TRUE(robot.last().matches.empty());
  }
  EXPECT_FALSE(robot.filter().state().blocks.empty());
}

TEST_P(Initialization, BearingsThatAreNotFiniteAreRefused) {
  auto robot = drive({0.0, 0.0, 0.0}, 1);
  for (int i = 0; i < 10; ++i) {
    robot.step({0.1, 0.0, 0.0}, {});
    robot.process({robot.detection(std::nan(""))});
  }
  EXPECT_TRUE(robot.filter().state().blocks.empty());
  EXPECT_TRUE(robot.filter().state().x.allFinite());
}

TEST_P(Initialization, PlacesAreAsGoodAsTheirCovarianceSays) {
  constexpr unsigned kSeeds = 40;
  double nees = 0.0, pose_nees = 0.0, squared_error = 0.0, frames = 0.0;
  int compared = 0, found = 0, strangers = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    auto robot = drive({}, seed);
    for (int i = 0; i < 130; ++i) robot.step({0.1, 0.0, 0.0}, kPillars);
    std::set<std::size_t> seen;
    for (const LandmarkRecord& record : robot.filter().landmarkMap()) {
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < kPillars.size(); ++k)
        if ((record.p_world - kPillars[k]).norm() < (record.p_world - kPillars[nearest]).norm())
          nearest = k;
      const Eigen::Vector2d error = record.p_world - kPillars[nearest];
      if (error.norm() > 0.7) {
        ++strangers;
        continue;
      }
      seen.insert(nearest);
      nees += error.dot(record.covariance.ldlt().solve(error)) / 2.0;
      squared_error += error.squaredNorm();
      ++compared;
    }
    found += static_cast<int>(seen.size());
    Eigen::Vector3d off = robot.filter().pose().vector() - robot.truth().vector();
    off(2) = wrapAngle(off(2));
    pose_nees += off.dot(robot.filter().poseCovariance().ldlt().solve(off)) / 3.0 / kSeeds;
    for (const Event& event : robot.events())
      if (event.what == "birth")
        frames += std::stod(event.reason.substr(event.reason.find("after ") + 6));
  }
  const double share = found / static_cast<double>(kSeeds * kPillars.size());
  std::cout << GetParam() << ": found " << share << ", strangers " << strangers
            << ", landmark NEES/2 " << nees / compared << ", RMSE "
            << std::sqrt(squared_error / compared) << " m, pose NEES/3 " << pose_nees << ", frames "
            << frames / compared << "\n";
  EXPECT_GT(share, 0.88);
  EXPECT_LT(strangers, 0.05 * compared);
  // The landmarks of one run share its drift; 40 runs of 3 shared numbers spread by some 0.2.
  EXPECT_GT(nees / compared, 0.5);
  EXPECT_LT(nees / compared, 1.6);
  EXPECT_LT(pose_nees, 1.8);
}

INSTANTIATE_TEST_SUITE_P(Policies, Initialization,
                         ::testing::Values("delayed", "gaussian-sum", "sample-entropy",
                                           "undelayed"),
                         [](const auto& info) {
                           std::string name = info.param;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

}  // namespace
}  // namespace colonnade
