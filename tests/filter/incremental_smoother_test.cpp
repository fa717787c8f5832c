// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/incremental_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "normal_equations.hpp"
#include "settle.hpp"
#include "simulated_drive.hpp"

namespace colonnade {
namespace {

using testing::simulatedDrive;

constexpr double kGate = 0.999999;

/// The frames of a drive that goes on, one after another.
class GoesOn {
 public:
  explicit GoesOn(const Drive& whole, double gate = kGate)
      : smoother(gate, whole.sensor), whole_(whole) {}

  void next() {
    const std::size_t k = frame_++;
    Pose2 T = whole_.T_world_robot[k];
    if (k > 0) T = smoother.pose(k - 1) * whole_.motions[k].T_previous_robot;
    smoother.addPose(T, whole_.motions[k]);
    for (const Drive::Sighting& sighting : whole_.sightings) {
      if (sighting.pose != k) continue;
      if (!point_[sighting.point]) found(sighting, T);
      Drive::Sighting here = sighting;
      here.point = *point_[sighting.point];
      smoother.addSighting(here);
    }
  }
  bool isOver() const { return frame_ == whole_.T_world_robot.size(); }

  IncrementalSmoother smoother;

 private:
  void found(const Drive::Sighting& sighting, const Pose2& T) {
    const auto& z = sighting.measurement.z;
    const double range = z.size() == 2 ? z(1) : 3.0;
    const Eigen::Vector2d ray(std::cos(z(0)), std::sin(z(0)));
    point_[sighting.point] = smoother.addPoint(transform(T, range * ray));
    if (z.size() == 1)
      smoother.addDepth(
          {sighting.pose, *point_[sighting.point], Eigen::Vector2d::Zero(), 0.3, 0.2});
  }

  const Drive& whole_;
  std::size_t frame_ = 0;
  std::vector<std::optional<std::size_t>> point_ =
      std::vector<std::optional<std::size_t>>(whole_.points_world.size());
};

Eigen::Matrix3d lastPoseCovariance(const Drive& drive) {
  const NormalEquations at(drive);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(at.H());
  const Eigen::Index last = at.poseAt(drive.T_world_robot.size() - 1);
  Eigen::Matrix3d P;
  for (Eigen::Index i = 0; i < 3; ++i)
    P.col(i) = factor.solve(Eigen::VectorXd::Unit(factor.rows(), last + i)).segment<3>(last);
  const Eigen::Matrix3d lift = liftOf(drive.T_world_robot.back());
  return lift * P * lift.transpose();
}

/// Every ten frames as far as if everything was solved again.
void expectAsBatch(const Drive& whole, double pose_sigmas) {
  GoesOn drive(whole);
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; !drive.isOver(); ++k) {
    drive.next();
    if (k % 10 != 9) continue;
    ASSERT_TRUE(drive.smoother.update());
    Drive batch = drive.smoother.drive();
    if (batch.sightings.empty()) continue;
    // The pose that is held is another one.
    const Pose2 to_first = batch.T_world_robot.front();
    Smoothing how;
    settle(batch, kGate, how);
    EXPECT_EQ(batch.T_world_robot.front().vector(), to_first.vector());
    EXPECT_LT(NormalEquations(drive.smoother.drive()).cost(), how.cost + 0.5) << k;
    const Eigen::Matrix3d P = lastPoseCovariance(batch);
    const Pose2 apart = drive.smoother.pose(k).inverse() * batch.T_world_robot.back();
    EXPECT_NEAR(std::log(drive.smoother.lastPoseCovariance().determinant() / P.determinant()), 0.0,
                0.2)
        << k;
    sum += apart.vector().cwiseAbs().cwiseQuotient(P.diagonal().cwiseSqrt()).maxCoeff();
    ++count;
  }
  EXPECT_LT(sum / count, pose_sigmas);
}

TEST(IncrementalSmoother, EndsWhereSmoothingEverythingAgainDoes) {
  for (unsigned seed = 1; seed <= 6; ++seed) expectAsBatch(simulatedDrive(seed).truth, 0.05);
}

TEST(IncrementalSmoother, EndsThereAfterAStretchWithoutReadings) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Drive whole = simulatedDrive(seed).truth;
    std::erase_if(whole.sightings, [](const auto& s) {
      return s.pose < 15 || (s.pose > 100 && s.pose < 160) || s.pose > 200;
    });
    expectAsBatch(whole, 0.1);
  }
}

TEST(IncrementalSmoother, EndsThereWithBearingsAlone) {
  for (unsigned seed = 1; seed <= 6; ++seed) expectAsBatch(simulatedDrive(seed, false).truth, 0.1);
}

TEST(IncrementalSmoother, EndsThereWithASensorThatIsOff) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Drive whole = simulatedDrive(seed).truth;
    for (Drive::Sighting& sighting : whole.sightings) sighting.measurement.z(1) *= 1.03;
    SensorErrors sigmas;
    sigmas.range_scale = 0.05;
    whole.sensor = {{}, sigmas};
    expectAsBatch(whole, 0.05);
    GoesOn drive(whole);
    while (!drive.isOver()) drive.next();
    ASSERT_TRUE(drive.smoother.update());
    EXPECT_NEAR(drive.smoother.drive().sensor->errors.range_scale, 0.03, 0.02);
  }
}

TEST(IncrementalSmoother, CovarianceOfTheLastPoseIsHonest) {
  constexpr int kDrives = 40;
  double nees = 0.0;
  for (unsigned seed = 200; seed < 200 + kDrives; ++seed) {
    const auto simulated = simulatedDrive(seed, false);
    GoesOn drive(simulated.truth, 1.0);
    while (!drive.isOver()) {
      for (int i = 0; i < 10 && !drive.isOver(); ++i) drive.next();
      ASSERT_TRUE(drive.smoother.update());
    }
    const Drive& known = drive.smoother.drive();
    // Given the first pose, whichever one is held.
    const Pose2 T = simulated.truth.T_world_robot.front() * known.T_world_robot.front().inverse();
    Eigen::Vector3d error =
        (T * known.T_world_robot.back()).vector() - simulated.truth.T_world_robot.back().vector();
    error(2) = wrapAngle(error(2));
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R.topLeftCorner<2, 2>() = T.rotation();
    const Eigen::Matrix3d P = R * drive.smoother.lastPoseCovariance() * R.transpose();
    nees += error.dot(P.inverse() * error) / 3.0 / kDrives;
  }
  // Chi-square of 120 degrees of freedom over 120: 0.76 to 1.27 in 95 of 100 cases.
  EXPECT_GT(nees, 0.7);
  EXPECT_LT(nees, 1.35);
}

TEST(IncrementalSmoother, WrongReadingsStayOutAndRightOnesComeIn) {
  Drive whole = simulatedDrive(31).truth;
  whole.sightings[40].measurement.z(0) += 1.0;  // goes out
  whole.sightings[60].measurement.z(0) += 1.0;
  whole.sightings[60].used = false;  // stays out
  whole.sightings[50].used = false;  // comes in
  GoesOn drive(whole);
  while (!drive.isOver()) {
    drive.next();
    EXPECT_EQ(drive.smoother.update(), drive.smoother.poses() > 1);
  }
  EXPECT_EQ(drive.smoother.unused(), 2u);
  EXPECT_FALSE(drive.smoother.isUsed(40));
  EXPECT_FALSE(drive.smoother.isUsed(60));
  EXPECT_TRUE(drive.smoother.isUsed(50));
}

TEST(IncrementalSmoother, WhatWasRemovedHasNoSay) {
  const Drive whole = simulatedDrive(32).truth;
  Drive without = whole;
  std::erase_if(without.sightings, [](const auto& s) { return s.pose >= 100 && s.pose < 120; });
  GoesOn all(whole), fewer(without);
  for (GoesOn* drive : {&all, &fewer})
    while (!drive->isOver()) {
      for (int i = 0; i < 10 && !drive->isOver(); ++i) drive->next();
      ASSERT_TRUE(drive->smoother.update());
    }
  for (std::size_t i = 0; i < whole.sightings.size(); ++i)
    if (whole.sightings[i].pose >= 100 && whole.sightings[i].pose < 120)
      all.smoother.removeSighting(i);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(all.smoother.update() && fewer.smoother.update());
  const auto relative = [](GoesOn& drive, std::size_t k) {
    return drive.smoother.pose(0).inverse() * drive.smoother.pose(k);
  };
  for (std::size_t k = 0; k < 240; k += 20)
    EXPECT_LT((relative(all, k).vector() - relative(fewer, k).vector()).norm(), 2e-3) << k;
  EXPECT_EQ(all.smoother.unused(), 0u);
}

TEST(IncrementalSmoother, OnePoseIsNoDrive) {
  IncrementalSmoother smoother(kGate, std::nullopt);
  EXPECT_FALSE(smoother.update());
  smoother.addPose({1.0, 2.0, 0.5}, {{}, Eigen::Matrix3d::Zero()});
  EXPECT_FALSE(smoother.update());
  // A standing robot states no noise at all.
  smoother.addPose({1.0, 2.0, 0.5}, {{}, Eigen::Matrix3d::Zero()});
  EXPECT_TRUE(smoother.update());
  EXPECT_LT((smoother.pose(1).vector() - Eigen::Vector3d(1.0, 2.0, 0.5)).norm(), 1e-9);
}

}  // namespace
}  // namespace colonnade
