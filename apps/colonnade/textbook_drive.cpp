// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "textbook_drive.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "colonnade/simulation/random.hpp"

namespace colonnade {
namespace {

double neesOf(const EkfSlam& filter, const Pose2& truth) {
  Eigen::Vector3d error = filter.pose().vector() - truth.vector();
  error(2) = wrapAngle(error(2));
  return error.dot(filter.poseCovariance().ldlt().solve(error)) / 3.0;
}

RangeBearingScan look(const TextbookWorld& world, const std::vector<Eigen::Vector2d>& landmarks,
                      const Pose2& truth, Random& random) {
  RangeBearingScan scan;
  scan.range_sigma_m = world.range_m;
  scan.yaw_sigma = world.bearing;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d p_robot = transform(truth.inverse(), landmarks[i]);
    const double bearing = std::atan2(p_robot.y(), p_robot.x());
    if (p_robot.norm() > world.view_m || std::abs(bearing) > world.view) continue;
    const double range = p_robot.norm() + world.range_m * random.normal();
    scan.readings.push_back(
        {static_cast<std::int32_t>(i), range, bearing + world.bearing * random.normal(), 0.0, {}});
  }
  return scan;
}

RangeBearingEstimator estimator(bool invariant) {
  FilterOptions filter;
  filter.invariant = invariant;
  return RangeBearingEstimator(RangeBearingOptions{}, filter);
}

}  // namespace

std::vector<Eigen::Vector2d> TextbookWorld::landmarks() const {
  // The robot's circle starts at the origin and has its centre to the left; an outer and an inner
  // square of pillars follow it.
  const double radius = step_m * steps_a_round / (2.0 * kPi);
  std::vector<Eigen::Vector2d> points;
  for (const double side : {radius + 1.8, radius - 1.8})
    for (int i = 0; i < 20; ++i) {
      const double along = side * (2.0 * (i % 5) / 5.0 - 1.0);
      const Eigen::Vector2d edge[] = {
          {along, -side}, {side, along}, {-along, side}, {-side, -along}};
      points.push_back(Eigen::Vector2d(0.0, radius) + edge[i / 5]);
    }
  return points;
}

TextbookDrive drive(const TextbookWorld& world, int rounds, std::uint64_t seed) {
  Random wheels(seed, "textbook wheels"), sensor(seed, "textbook sensor");
  const auto landmarks = world.landmarks();
  RangeBearingEstimator plain = estimator(false), invariant = estimator(true);
  MotionIncrement motion;  // none before the first look
  const Eigen::Vector3d sigma(world.along_m, world.across_m, world.heading);
  TextbookDrive result;
  Pose2 truth, dead_reckoning;
  for (int i = 0; i <= rounds * world.steps_a_round; ++i) {
    const auto scan = look(world, landmarks, truth, sensor);
    for (RangeBearingEstimator* filter : {&plain, &invariant}) filter->step(i, motion, scan);
    result.truth.push_back(truth);
    result.dead_reckoning.push_back(dead_reckoning);
    result.plain.push_back(plain.filter().pose());
    result.invariant.push_back(invariant.filter().pose());
    // The robot keeps to its circle; what its wheels tell is off by the noise.
    const Pose2 way{world.step_m, 0.0, 2.0 * kPi / world.steps_a_round};
    truth = truth * way;
    motion.T_previous_robot = {way.x + sigma(0) * wheels.normal(), sigma(1) * wheels.normal(),
                               way.phi + sigma(2) * wheels.normal()};
    motion.covariance = sigma.cwiseAbs2().asDiagonal();
    dead_reckoning = dead_reckoning * motion.T_previous_robot;
  }
  result.nees_plain = neesOf(plain.filter(), result.truth.back());
  result.nees_invariant = neesOf(invariant.filter(), result.truth.back());
  result.landmarks = invariant.map();
  return result;
}

}  // namespace colonnade
