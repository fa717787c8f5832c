// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

/// A pillar, a wall to the left and a room corner ahead.
Scene scene() {
  Scene s;
  s.faces.push_back({{3.2, -1.5}, {3.2, 1.3}, 150.0});
  s.faces.push_back({{-1.0, 1.3}, {3.2, 1.3}, 120.0});
  s.faces.push_back({{2.0, -0.5}, {2.0, -0.2}, 60.0});
  return s;
}

struct Nees {
  double sum = 0.0;
  int count = 0;
  int numbers = 0;
  void add(const Measurement& m, const Eigen::Vector2d& truth) {
    Eigen::Vector2d error = m.z - truth;
    error[0] = wrapAngle(error[0]);
    sum += error.dot(m.R.inverse() * error);
    ++count;
    numbers += 2;
  }
  double mean() const { return sum / numbers; }
};

/// Covariances must cover pixel noise, depth noise and the stated uncertainty of the mounting. They
/// also hold floors for errors that synthetic images do not have, so NEES below 1 is expected.
TEST(Detectors, CovariancesCoverTheErrors) {
  const CameraPlace place{1.1, radians(12.0), radians(2.0), 0.0, {0.05, 0.0}};
  const Frame clean = render(scene(), place);
  const GeometryOptions geometry;
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  Nees pillar;
  Nees floor;
  Nees corner;
  constexpr int kFrames = 40;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    Frame frame = withNoise(clean, 3.0, 100 + i);
    // The mounting is assumed a little wrong: turned about the robot's x and y axes, and too high.
    frame.T_robot_camera.linear() =
        Eigen::AngleAxisd(geometry.tilt_sigma * normal(generator), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(geometry.tilt_sigma * normal(generator), Eigen::Vector3d::UnitY()) *
        frame.T_robot_camera.linear();
    frame.T_robot_camera.translation().z() += geometry.height_sigma_m * normal(generator);
    const auto all = detectAll(frame);
    const auto towards = [&](LandmarkKind kind, double bearing) -> const Measurement* {
      static Detections some;
      some = accepted(all, kind);
      const auto* found = nearestBearing(some, bearing);
      const bool near = found && std::abs(wrapAngle(found->measurement.z[0] - bearing)) < 0.1;
      return near && found->measurement.hasRange() ? &found->measurement : nullptr;
    };
    for (const auto& p_robot : {Eigen::Vector2d(2.0, -0.5), Eigen::Vector2d(2.0, -0.2)}) {
      const Eigen::Vector2d offset = p_robot - place.p_robot;
      const Eigen::Vector2d truth(bearingOf(offset), offset.norm());
      if (const auto* m = towards(LandmarkKind::kPillarEdge, truth[0])) pillar.add(*m, truth);
    }
    if (const auto* m = towards(LandmarkKind::kFloorEdge, kPi / 2)) floor.add(*m, {kPi / 2, 1.3});
    const Eigen::Vector2d offset = Eigen::Vector2d(3.2, 1.3) - place.p_robot;
    const Eigen::Vector2d truth(bearingOf(offset), offset.norm());
    if (const auto* m = towards(LandmarkKind::kDepthSlope, truth[0])) corner.add(*m, truth);
  }
  EXPECT_GE(pillar.count, 2 * kFrames - 4);
  EXPECT_GE(floor.count, kFrames - 6);
  EXPECT_GE(corner.count, kFrames - 8);
  RecordProperty("pillar_nees", std::to_string(pillar.mean()));
  RecordProperty("floor_nees", std::to_string(floor.mean()));
  RecordProperty("corner_nees", std::to_string(corner.mean()));
  EXPECT_LT(pillar.mean(), 1.5);
  EXPECT_LT(corner.mean(), 1.5);
  EXPECT_LT(floor.mean(), 1.6);
  EXPECT_GT(floor.mean(), 0.3);  // mounting errors, which the test does have, rule here
}

/// Without the floor for systematic errors, the covariance of the fit itself must be honest.
TEST(Detectors, LineFitsKnowTheirError) {
  const CameraPlace place{1.1, radians(12.0), radians(2.0), 0.0, {0.05, 0.0}};
  const Frame clean = render(scene(), place);
  DetectorOptions options;
  options.geometry.line_sigma_px = 0.0;
  options.geometry.tilt_sigma = 0.0;
  double sum = 0.0;
  int count = 0;
  for (std::uint32_t i = 0; i < 30; ++i) {
    const auto pillars =
        accepted(detectAll(withNoise(clean, 6.0, 200 + i), options), LandmarkKind::kPillarEdge);
    for (const auto& p_robot : {Eigen::Vector2d(2.0, -0.5), Eigen::Vector2d(2.0, -0.2)}) {
      const double truth = bearingOf(p_robot - place.p_robot);
      const auto* found = nearestBearing(pillars, truth);
      ASSERT_TRUE(found);
      const double error = wrapAngle(found->measurement.z[0] - truth);
      if (std::abs(error) > 0.02) continue;
      sum += error * error / found->measurement.R(0, 0);
      ++count;
    }
  }
  EXPECT_GE(count, 56);
  EXPECT_LT(sum / count, 2.0);
  EXPECT_GT(sum / count, 0.1);
  RecordProperty("nees", std::to_string(sum / count));
}

}  // namespace
}  // namespace colonnade::testing
