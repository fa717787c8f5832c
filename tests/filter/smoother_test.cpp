// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "colonnade/base/angle.hpp"
#include "normal_equations.hpp"
#include "simulated_drive.hpp"

namespace colonnade {
namespace {

using testing::kBearingSigma;
using testing::kRangeSigma_m;
using testing::poseError;
using testing::SimulatedDrive;
using testing::simulatedDrive;

constexpr double kGate = 0.999999;

/// Of the start and the first five points, each wrong by so much; correlated.
Drive::Prior priorAround(const Drive& drive, double wrong_m) {
  Drive::Prior prior;
  prior.T_world_start = drive.T_world_robot.front() * Pose2{wrong_m, -wrong_m, 0.1};
  prior.information_start = Eigen::Vector3d(100.0, 80.0, 400.0).asDiagonal();
  prior.information_start(0, 2) = prior.information_start(2, 0) = 30.0;
  for (std::size_t i = 0; i < 5; ++i)
    prior.points_world.emplace_back(drive.points_world[i] + Eigen::Vector2d(wrong_m, wrong_m));
  prior.information_points = Eigen::MatrixXd::Constant(10, 10, 5.0);
  prior.information_points.diagonal().array() += 100.0;
  return prior;
}

TEST(NormalEquations, GradientIsHalfTheNumericOneOfTheCost) {
  for (const bool ranged : {true, false}) {
    Drive here = simulatedDrive(3, ranged).start;
    if (ranged) here.prior = priorAround(here, 0.2);
    for (auto& sighting : here.sightings) sighting.measurement.p_robot_camera << 0.2, -0.1;
    if (!ranged)
      for (std::size_t i = 0; i < here.points_world.size(); ++i)
        here.depths.push_back({11 * i, i, {0.2, -0.1}, 0.5, 0.25});
    here.sightings[5].measurement.z(0) += 0.4;  // one with Huber's loss, if none had it
    const NormalEquations at(here);
    constexpr double kStep = 1e-6;
    const auto check = [&](Eigen::Index i) {
      Drive above = here, below = here;
      const Eigen::VectorXd dx = kStep * Eigen::VectorXd::Unit(at.g().size(), i);
      move(above, at, dx);
      move(below, at, -dx);
      const double cost_above = NormalEquations(above).cost();
      const double numeric = (cost_above - NormalEquations(below).cost()) / (4.0 * kStep);
      const double rounding = 1e-15 * cost_above / kStep;
      EXPECT_NEAR(at.g()(i), numeric, 1e-5 * std::abs(numeric) + 100.0 * rounding) << i;
    };
    for (Eigen::Index i = 0; i < at.pointAt(0); i += 17) check(i);
    for (Eigen::Index i = at.pointAt(0); i < at.g().size(); ++i) check(i);
  }
}

TEST(NormalEquations, ACommonMotionOfAllPosesChangesNoMotion) {
  Drive drive = simulatedDrive(4).start;
  drive.sightings.clear();
  const double before = NormalEquations(drive).cost();
  const Pose2 T = exponential({0.7, -2.0, 1.1});
  for (Pose2& pose : drive.T_world_robot) pose = T * pose;
  EXPECT_NEAR(NormalEquations(drive).cost(), before, 1e-6);
}

TEST(Smoother, FindsTheTruthFromPerfectReadingsAndAWrongStart) {
  SimulatedDrive drive = simulatedDrive(5, true, 0.0);
  Drive& estimate = drive.start;
  Pose2 off;
  for (Pose2& pose : estimate.T_world_robot) {  // a bend of 100 degrees over the whole way
    off = exponential({0.002, -0.003, radians(100.0) / 240.0}) * off;
    pose = off * pose;
  }
  estimate.T_world_robot.front() = {};
  EXPECT_GT(poseError(estimate, drive.truth), 1.0);
  const Smoothing result = smooth(estimate, kGate);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.unused, 0u);
  EXPECT_LT(poseError(estimate, drive.truth), 1e-3);
  for (std::size_t i = 0; i < drive.truth.points_world.size(); ++i)
    EXPECT_LT((estimate.points_world[i] - drive.truth.points_world[i]).norm(), 1e-3) << i;
}

TEST(Smoother, HalvesTheErrorOfDeadReckoningWithBearingsAlone) {
  double before = 0.0, after = 0.0;
  for (unsigned seed = 11; seed < 21; ++seed) {
    SimulatedDrive drive = simulatedDrive(seed, false);
    before += poseError(drive.start, drive.truth);
    const Smoothing result = smooth(drive.start, kGate);
    after += poseError(drive.start, drive.truth);
    EXPECT_TRUE(result.converged);
    // No better explanation was missed: the truth is none, but for what was fitted to the noise.
    EXPECT_LT(result.cost, NormalEquations(drive.truth).cost()) << seed;
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST(Smoother, CovariancesOfThePointsAreHonest) {
  double sum = 0.0;
  int count = 0;
  for (unsigned seed = 100; seed < 140; ++seed) {
    SimulatedDrive drive = simulatedDrive(seed);
    const Smoothing result = smooth(drive.start, 1.0);
    for (std::size_t i = 0; i < drive.truth.points_world.size(); ++i) {
      const Eigen::Vector2d error = drive.start.points_world[i] - drive.truth.points_world[i];
      const auto row = static_cast<Eigen::Index>(2 * i);
      const Eigen::Matrix2d P = result.covariance.block<2, 2>(row, row);
      sum += error.dot(P.inverse() * error) / 2.0;
      ++count;
    }
  }
  // Points of one drive err together: 40 drives, about two free directions each.
  EXPECT_GT(sum / count, 0.7);
  EXPECT_LT(sum / count, 1.35);
}

/// Two bearings that hardly differ meet anywhere, and cross right before the robot by chance.
TEST(Smoother, WhatIsKnownOfADepthKeepsAPointAway) {
  Drive drive;
  drive.T_world_robot = {{}, {0.1, 0.0, 0.0}};
  drive.motions = {{{}, Eigen::Matrix3d::Zero()},
                   {{0.1, 0.0, 0.0}, 1e-6 * Eigen::Matrix3d::Identity()}};
  drive.points_world = {{3.0, 0.02}};
  for (const std::size_t pose : {0, 1}) {
    Measurement m;
    m.z.resize(1);
    m.z << (pose == 0 ? 0.01 : 0.04);
    m.R.setConstant(1, 1, kBearingSigma * kBearingSigma);
    drive.sightings.push_back({pose, 0, m});
  }
  Drive with = drive;
  with.depths.push_back({0, 0, Eigen::Vector2d::Zero(), 0.35, 0.25});
  smooth(drive, kGate);
  smooth(with, kGate);
  EXPECT_LT(drive.points_world[0].norm(), 0.5);
  EXPECT_NEAR(with.points_world[0].norm(), 1.0 / 0.35, 1.0);
}

TEST(Smoother, AWrongReadingStaysOutWhereItStartsOut) {
  SimulatedDrive drive = simulatedDrive(31);
  Drive& estimate = drive.start;
  estimate.sightings[40].measurement.z(0) += 1.0;
  estimate.sightings[40].used = false;
  estimate.sightings[50].used = false;  // a right one comes in
  const Smoothing result = smooth(estimate, kGate);
  EXPECT_EQ(result.unused, 1u);
  EXPECT_FALSE(estimate.sightings[40].used);
  EXPECT_TRUE(estimate.sightings[50].used);
}

TEST(Smoother, LeavesWrongReadingsOut) {
  SimulatedDrive drive = simulatedDrive(6);
  std::size_t wrong = 0;
  for (std::size_t i = 7; i < drive.start.sightings.size(); i += 25, ++wrong)
    drive.start.sightings[i].point = (drive.start.sightings[i].point + 3) % 12;
  SimulatedDrive clean = simulatedDrive(6);
  smooth(clean.start, kGate);
  const Smoothing result = smooth(drive.start, kGate);
  EXPECT_NEAR(static_cast<double>(result.unused), static_cast<double>(wrong), 2.0);
  EXPECT_LT(poseError(drive.start, drive.truth), 1.3 * poseError(clean.start, clean.truth));
}

TEST(Smoother, AStandingRobotWithoutNoiseIsNoDivisionByZero) {
  SimulatedDrive drive = simulatedDrive(7);
  for (std::size_t k = 100; k < 120; ++k) drive.start.motions[k] = {{}, Eigen::Matrix3d::Zero()};
  smooth(drive.start, 1.0);
  for (std::size_t k = 100; k < 120; ++k) {
    const Pose2 moved = drive.start.T_world_robot[k - 1].inverse() * drive.start.T_world_robot[k];
    EXPECT_LT(moved.vector().cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(Smoother, AStretchBentToSuitWrongReadingsIsMended) {
  // Between two blind turns a single frame sees posts, all half a turn from where they stand.
  SimulatedDrive drive = simulatedDrive(9, false);
  const Drive clean = drive.start;
  const auto within = [](std::size_t pose) { return pose >= 100 && pose < 103; };
  std::erase_if(drive.start.sightings,
                [&](const auto& s) { return within(s.pose) && s.pose != 101; });
  for (auto& motion : {100, 103}) {
    auto& covariance = drive.start.motions[static_cast<std::size_t>(motion)].covariance;
    covariance(2, 2) = std::pow(radians(15.0), 2);
  }
  std::size_t wrong = 0;
  for (auto& sighting : drive.start.sightings)
    if (within(sighting.pose)) {
      sighting.measurement.z(0) = wrapAngle(sighting.measurement.z(0) + radians(160.0));
      ++wrong;
    }
  ASSERT_GT(wrong, 0u);
  const Smoothing result = smooth(drive.start, kGate);
  EXPECT_EQ(result.unused, wrong);
  for (std::size_t k = 99; k < 104; ++k) {
    const Pose2 off = drive.start.T_world_robot[k].inverse() * drive.truth.T_world_robot[k];
    EXPECT_LT(std::abs(wrapAngle(off.phi)), radians(25.0)) << k;
  }
}

TEST(Smoother, ReadingsThatAreNoMeasurementsAreLeftOut) {
  SimulatedDrive drive = simulatedDrive(10);
  drive.start.sightings[3].measurement.z(0) = std::nan("");
  drive.start.sightings[30].measurement.R(1, 1) = -1.0;  // counts as exact, which it is not
  drive.start.sightings[40].measurement.R(0, 1) = drive.start.sightings[40].measurement.R(1, 0) =
      1.0;
  const Smoothing result = smooth(drive.start, kGate);
  EXPECT_TRUE(std::isfinite(result.cost));
  EXPECT_FALSE(drive.start.sightings[3].used);
  EXPECT_FALSE(drive.start.sightings[40].used);
  EXPECT_LE(result.unused, 4u);
  EXPECT_LT(poseError(drive.start, drive.truth), 0.3);
}

TEST(Smoother, APriorSaysWhereTheWorldIs) {
  // The same drive, seen from a world in which nobody knows the start and all know the points.
  const Pose2 T{3.0, -1.0, 2.0};
  SimulatedDrive drive = simulatedDrive(13);
  Drive::Prior prior;
  prior.T_world_start = T * Pose2{0.4, -0.3, 0.2};
  prior.information_start = Eigen::Vector3d(4.0, 4.0, 20.0).asDiagonal();
  for (const auto& point : drive.truth.points_world)
    prior.points_world.push_back(transform(T, point));
  const auto size = static_cast<Eigen::Index>(2 * prior.points_world.size());
  prior.information_points = 1e4 * Eigen::MatrixXd::Identity(size, size);
  for (Pose2& pose : drive.start.T_world_robot) pose = prior.T_world_start * pose;
  for (auto& point : drive.start.points_world) point = transform(prior.T_world_start, point);
  for (Pose2& pose : drive.truth.T_world_robot) pose = T * pose;
  drive.start.prior = prior;
  const Smoothing result = smooth(drive.start, kGate);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(poseError(drive.start, drive.truth), 0.03);
  EXPECT_LT(result.covariance.diagonal().maxCoeff(), 1e-4);
}

TEST(Smoother, APointNothingSawStaysAndOneFrameIsNoDrive) {
  SimulatedDrive drive = simulatedDrive(12);
  drive.start.points_world.emplace_back(50.0, 50.0);
  const Smoothing result = smooth(drive.start, kGate);
  EXPECT_EQ(drive.start.points_world.back(), Eigen::Vector2d(50.0, 50.0));
  EXPECT_GT(result.covariance.diagonal().tail<1>()(0), 100.0);

  Drive one = simulatedDrive(12).start;
  one.T_world_robot.resize(1);
  one.motions.resize(1);
  std::erase_if(one.sightings, [](const auto& s) { return s.pose > 0; });
  EXPECT_EQ(smooth(one, kGate).steps, 0);
}

/// After so many sightings a point's are of a second one founded beside it.
void foundTwice(Drive& drive, std::size_t point, int sightings, const Eigen::Vector2d& beside) {
  drive.points_world.emplace_back(drive.points_world[point] + beside);
  for (auto& sighting : drive.sightings)
    if (sighting.point == point && --sightings < 0) sighting.point = drive.points_world.size() - 1;
  drive.nameless.assign(drive.points_world.size(), true);
}

TEST(Smoother, PointsFoundedTwiceBecomeOne) {
  for (unsigned seed = 30; seed < 40; ++seed) {
    SimulatedDrive drive = simulatedDrive(seed), named = drive;
    for (Drive* d : {&drive.start, &named.start}) {
      foundTwice(*d, 3, 25, {0.15, -0.1});
      foundTwice(*d, 6, 12, {-0.1, 0.1});
      foundTwice(*d, 13, 11, {0.1, 0.1});  // for the third time
    }
    const Smoothing result = smooth(drive.start, kGate);
    std::vector<std::size_t> gone;
    for (const auto& [point, into] : result.merged) gone.push_back(point);
    EXPECT_EQ(gone.size(), 3u) << seed;
    for (const std::size_t point : gone)
      EXPECT_TRUE(std::none_of(drive.start.sightings.begin(), drive.start.sightings.end(),
                               [&](const auto& s) { return s.point == point; }));
    // Like a drive that never took one for two.
    SimulatedDrive once = simulatedDrive(seed);
    smooth(once.start, kGate);
    EXPECT_NEAR(poseError(drive.start, drive.truth), poseError(once.start, once.truth), 0.02);

    named.start.nameless.assign(named.start.points_world.size(), false);
    EXPECT_TRUE(smooth(named.start, kGate).merged.empty());
  }
}

/// Of all points of the drive, each known so well.
Drive::Prior priorOf(const SimulatedDrive& drive, double sigma_m) {
  const auto numbers = static_cast<Eigen::Index>(2 * drive.start.points_world.size());
  return {drive.truth.T_world_robot.front(), 1e4 * Eigen::Matrix3d::Identity(),
          drive.truth.points_world,
          Eigen::MatrixXd::Identity(numbers, numbers) / (sigma_m * sigma_m)};
}

/// As far as what is known of the two lets them be one.
TEST(Smoother, WhatAPriorHoldsTwiceBecomesOne) {
  for (unsigned seed = 60; seed < 66; ++seed) {
    for (const bool is_twice : {true, false}) {
      SimulatedDrive drive = simulatedDrive(seed);
      Drive& d = drive.start;
      const Eigen::Vector2d beside(0.12, 0.0);
      foundTwice(d, 4, 20, beside);
      drive.truth.points_world.emplace_back(drive.truth.points_world[4] + beside);
      if (!is_twice)  // what is seen later is the other one
        for (auto& sighting : d.sightings) {
          if (sighting.point != 12) continue;
          sighting.measurement.z +=
              predictMeasurement(drive.truth.T_world_robot[sighting.pose], BlockKind::kPoint,
                                 drive.truth.points_world[12], sighting.measurement)
                  .z -
              predictMeasurement(drive.truth.T_world_robot[sighting.pose], BlockKind::kPoint,
                                 drive.truth.points_world[4], sighting.measurement)
                  .z;
        }
      d.prior = priorOf(drive, is_twice ? 0.1 : 0.01);
      const Smoothing result = smooth(d, kGate);
      EXPECT_EQ(result.merged.size(), is_twice ? 1u : 0u) << seed;
      EXPECT_EQ(d.one.size(), result.merged.size());
      EXPECT_EQ((d.points_world[4] - d.points_world[12]).norm() < 1e-3, is_twice);
      const auto rows = result.covariance.rows();
      EXPECT_EQ(result.covariance.diagonal().segment<2>(8).isApprox(
                    result.covariance.diagonal().segment<2>(rows - 2), 1e-3),
                is_twice);
    }
  }
}

/// What is new goes even where it was seen more often: a prior is not lost.
TEST(Smoother, WhatIsKnownBeforehandStays) {
  SimulatedDrive drive = simulatedDrive(70);
  Drive::Prior prior = priorOf(drive, 0.1);
  foundTwice(drive.start, 4, 12, {0.1, 0.05});
  drive.start.prior = prior;
  const Smoothing result = smooth(drive.start, kGate);
  ASSERT_EQ(result.merged.size(), 1u);
  EXPECT_EQ(result.merged.front().point, 12u);
  EXPECT_EQ(result.merged.front().into, 4u);
  EXPECT_TRUE(drive.start.one.empty());
}

/// Of a point 0.12 m beside another only those seen together can be told; one 0.3 m beside can,
/// seen together or not. A name that was read thrice is not taken by what is seen often beside it.
TEST(Smoother, NeighboursStayTwo) {
  enum class Case { kTogether, kSometimes, kByTurns, kAlone, kNamedAndRare };
  for (const Case how :
       {Case::kTogether, Case::kSometimes, Case::kByTurns, Case::kAlone, Case::kNamedAndRare}) {
    for (unsigned seed = 50; seed < 60; ++seed) {
      SimulatedDrive drive = simulatedDrive(seed);
      Drive& d = drive.start;
      const bool is_far = how == Case::kByTurns || how == Case::kNamedAndRare;
      const Eigen::Vector2d beside(is_far ? 0.3 : 0.12, 0.0);
      d.points_world.emplace_back(d.points_world[4] + beside);
      d.nameless.assign(d.points_world.size(), true);
      std::vector<Drive::Sighting> second;
      for (const auto& sighting : d.sightings) {
        if (sighting.point != 4) continue;
        const Pose2& T = drive.truth.T_world_robot[sighting.pose];
        const Eigen::Vector2d p = transform(T.inverse(), drive.truth.points_world[4]);
        const Eigen::Vector2d q = transform(T.inverse(), drive.truth.points_world[4] + beside);
        Drive::Sighting other = sighting;
        other.point = d.points_world.size() - 1;
        other.measurement.z(0) += std::atan2(q.y(), q.x()) - std::atan2(p.y(), p.x());
        other.measurement.z(1) += q.norm() - p.norm();
        second.push_back(other);
      }
      // Odd poses see the one, even ones the other, or some of them both.
      const auto isWithFirst = [&](std::size_t pose) {
        return how == Case::kTogether || pose % 2 == 1 ||
               (how == Case::kSometimes && pose % 3 == 0);
      };
      const auto isWithSecond = [&](std::size_t pose) {
        return how == Case::kTogether || pose % 2 == 0 ||
               (how == Case::kSometimes && pose % 3 == 0);
      };
      std::erase_if(d.sightings,
                    [&](const auto& s) { return s.point == 4 && !isWithFirst(s.pose); });
      std::erase_if(second, [&](const auto& s) { return !isWithSecond(s.pose); });
      if (how == Case::kNamedAndRare) {
        second.resize(3);
        d.nameless.back() = false;
      }
      d.sightings.insert(d.sightings.end(), second.begin(), second.end());
      if (how == Case::kAlone)  // a sensor of one reading: who is seen without whom says nothing
        std::erase_if(d.sightings, [&](const auto& s) {
          return s.point != 4 && s.point != d.points_world.size() - 1 &&
                 std::any_of(d.sightings.begin(), d.sightings.end(), [&](const auto& o) {
                   return o.pose == s.pose &&
                          (o.point == 4 || o.point == d.points_world.size() - 1);
                 });
        });
      EXPECT_TRUE(smooth(d, kGate).merged.empty()) << seed << static_cast<int>(how);
    }
  }
}

TEST(Smoother, WithoutSightingsNothingMoves) {
  Drive drive = simulatedDrive(8).start;
  drive.sightings.clear();
  const auto before = drive.T_world_robot;
  EXPECT_FALSE(smooth(drive, kGate).converged);
  EXPECT_EQ(before.back().x, drive.T_world_robot.back().x);
}

}  // namespace
}  // namespace colonnade
