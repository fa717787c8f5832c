// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "standing_part.hpp"

#include <gtest/gtest.h>

#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::Scene;

/// A robot that drives 0.1 m towards somebody in a closed corridor.
class StandingPart : public ::testing::Test {
 protected:
  std::optional<Reference> standing(const Eigen::Vector3d& walk, double read_m) const {
    Scene scene = Scene::corridor(true, true);
    scene.depth_noise = 0.002;
    scene.person = testing::Person{{2.0, 0.2, 0.0}};
    const auto before = cameraInWorld(0.0, 0.0, 1.1, 0.0, radians(12.0));
    const auto now = cameraInWorld(0.1, 0.0, 1.1, 0.0, radians(12.0));
    const Reference reference = makeReference(makePyramid(scene.render(0, 0.0, before), 4));
    scene.person->p_feet += walk;
    const RgbdPyramid current = makePyramid(scene.render(1, 0.1, now), 4);
    const auto read = cameraInWorld(read_m, 0.0, 1.1, 0.0, radians(12.0));
    Matrix6 covariance = Matrix6::Zero();
    covariance.diagonal() << Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(1e-5);
    return standingPart(reference, current, before.inverse() * read, covariance, 0.0);
  }
  /// Points of the person, 1.9 to 2.1 m in front of the camera that looks down by 12 degrees.
  static bool isOnPerson(const Eigen::Vector3f& p_reference) {
    const Eigen::Vector3d p =
        cameraInWorld(0.0, 0.0, 1.1, 0.0, radians(12.0)) * p_reference.cast<double>();
    return std::abs(p.x() - 2.0) < 0.1 && p.z() > 0.2 && std::abs(p.y() - 0.2) < 0.25;
  }
};

TEST_F(StandingPart, LacksWhoWalksAndKeepsTheRest) {
  for (const Eigen::Vector3d& walk :
       {Eigen::Vector3d(0.1, 0.0, 0.0), Eigen::Vector3d(-0.1, 0.02, 0.0)}) {
    const auto part = standing(walk, 0.103);
    ASSERT_TRUE(part);
    for (const auto& point : part->surfaces) EXPECT_FALSE(isOnPerson(point.p_reference));
    for (const auto& point : part->photometric.front()) EXPECT_FALSE(isOnPerson(point.p_reference));
    EXPECT_GT(part->surfaces.size(), 1000U);
    EXPECT_GT(part->photometric.front().size(), 2000U);
  }
}

TEST_F(StandingPart, IsNotAskedForWhereNothingMoves) {
  EXPECT_FALSE(standing(Eigen::Vector3d::Zero(), 0.103));
}

TEST_F(StandingPart, IsNotAskedForWhereAWallSeemsToMove) {
  // The wheels have slipped: a wall and a person ahead are not where they should be.
  for (const double read_m : {0.25, 0.3}) EXPECT_FALSE(standing(Eigen::Vector3d::Zero(), read_m));
}

TEST_F(StandingPart, LeavesAloneWhatMovesNoMoreThanWheelsErr) {
  EXPECT_FALSE(standing({0.01, 0.0, 0.0}, 0.103));
}

TEST(PlaneDistance, HasTheNumericDerivative) {
  const Eigen::Isometry3d T_reference_camera =
      expSe3((Vector6() << 0.1, -0.2, 0.05, 0.1, -0.3, 0.2).finished());
  const Eigen::Vector3d n_reference = Eigen::Vector3d(0.3, -0.2, -0.9).normalized();
  const Eigen::Vector3d p_reference(0.4, -0.3, 2.0);
  const auto inCamera = [&](const Vector6& e) {
    return Eigen::Isometry3d((T_reference_camera * expSe3(e)).inverse());
  };
  const Eigen::Vector3d seen = inCamera(Vector6::Zero()) * p_reference;
  const auto distance = [&](const Vector6& e) {
    const Eigen::Isometry3d T = inCamera(e);
    return (T.linear() * n_reference).dot(T * p_reference - seen);
  };
  const Vector6 J = planeDistanceByCamera(inCamera(Vector6::Zero()).linear() * n_reference, seen);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6 e = kStep * Vector6::Unit(i);
    EXPECT_NEAR(J(i), (distance(e) - distance(-e)) / (2.0 * kStep), 1e-7);
  }
}

}  // namespace
}  // namespace colonnade
