// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/incremental_smoother.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "normal_equations.hpp"
#include "simulated_drive.hpp"

namespace colonnade {
namespace {

using testing::simulatedDrive;

constexpr double kGate = 0.999999;

/// The frames of a drive that goes on, one after another.
class GoesOn {
 public:
  explicit GoesOn(const Drive& whole) : whole_(whole), smoother(kGate, whole.sensor) {}

  void next() {
    const std::size_t k = frame_++;
    Pose2 T = whole_.T_world_robot[k];
    if (k > 0) T = smoother.drive().T_world_robot[k - 1] * whole_.motions[k].T_previous_robot;
    smoother.addPose(T, whole_.motions[k]);
    for (const Drive::Sighting& sighting : whole_.sightings) {
      if (sighting.pose != k) continue;
      if (!point_[sighting.point]) {
        const auto& z = sighting.measurement.z;
        const double range = z.size() == 2 ? z(1) : 3.0;
        point_[sighting.point] = smoother.addPoint(
            transform(T, range * Eigen::Vector2d(std::cos(z(0)), std::sin(z(0)))));
        if (z.size() == 1)
          smoother.addDepth({k, *point_[sighting.point], Eigen::Vector2d::Zero(), 0.3, 0.2});
      }
      Drive::Sighting here = sighting;
      here.point = *point_[sighting.point];
      smoother.addSighting(here);
    }
  }
  bool isOver() const { return frame_ == whole_.T_world_robot.size(); }

 private:
  const Drive& whole_;
  std::size_t frame_ = 0;
  std::vector<std::optional<std::size_t>> point_ =
      std::vector<std::optional<std::size_t>>(whole_.points_world.size());

 public:
  IncrementalSmoother smoother;
};

TEST(IncrementalSmoother, EndsWhereSmoothingEverythingDoes) {
  for (const bool ranged : {true, false}){double worst=0,worst_cost=0,worst_det=0,sum=0;int n=0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const auto simulated = simulatedDrive(seed, ranged);
      GoesOn drive(simulated.truth);
      for (std::size_t k = 0; !drive.isOver(); ++k) {
        drive.next();
        if (k % 10 != 9) continue;
        ASSERT_TRUE(drive.smoother.update());
        Drive batch = drive.smoother.drive();
        const Smoothing how = smoothOn(batch, kGate);
        const double cost = NormalEquations(drive.smoother.drive()).cost();
        const double unused = static_cast<double>(drive.smoother.unused());worst_cost=std::max(worst_cost,cost-how.cost); (void)unused;
        const auto covariance = lastPoseCovariance(batch);
        ASSERT_TRUE(covariance);
        const Eigen::Matrix3d P = drive.smoother.lastPoseCovariance();
        const Pose2 apart = drive.smoother.drive().T_world_robot.back().inverse() * batch.T_world_robot.back();
        const Eigen::Vector3d sigmas = covariance->diagonal().cwiseSqrt();
        const double a=apart.vector().cwiseAbs().cwiseQuotient(sigmas).maxCoeff(); worst=std::max(worst,a); sum+=a; ++n; const double d=std::abs(std::log(P.determinant() / covariance->determinant())); worst_det=std::max(worst_det,d);
      }
    }
  std::printf("ranged %d cost %.3f pose %.3f mean %.3f det %.3f\n",ranged,worst_cost,worst,sum/n,worst_det);}
}

}  // namespace
}  // namespace colonnade
