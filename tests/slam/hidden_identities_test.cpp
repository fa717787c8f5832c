// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Readings without identity in a map that is left as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "colonnade/slam/range_bearing_estimator.hpp"
#include "map_of_posts.hpp"

namespace colonnade {
namespace {

/// One that is left as it is.
Resumption fixedMapOf(const std::vector<Eigen::Vector2d>& posts, double sigma_m) {
  Resumption from = testing::mapOf(posts, sigma_m);
  from.localize = true;
  return from;
}

/// A robot that looks at posts without names.
class Looks {
 public:
  explicit Looks(unsigned seed) : random_(seed) {}
  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }
  Pose2 pose(double sigma_m, double sigma_heading) {
    return {gauss(sigma_m), gauss(sigma_m), gauss(sigma_heading)};
  }
  std::vector<Eigen::Vector2d> posts(int count) {
    std::uniform_real_distribution<double> place(-6.0, 6.0);
    std::vector<Eigen::Vector2d> posts;
    for (int i = 0; i < count; ++i) posts.emplace_back(place(random_), place(random_));
    return posts;
  }
  /// Adds a reading, if the post is in view.
  void look(const Pose2& T_world_robot, const Eigen::Vector2d& post, RangeBearingScan& scan,
            double reach_m = 3.0) {
    const Eigen::Vector2d p = transform(T_world_robot.inverse(), post);
    const double bearing = std::atan2(p.y(), p.x());
    if (p.norm() < reach_m && std::abs(bearing) < 0.5)
      scan.readings.push_back(
          {-1, p.norm() + gauss(scan.range_sigma_m), bearing + gauss(scan.yaw_sigma), 0.0, {}});
  }

 private:
  std::mt19937 random_;
};

RangeBearingScan scanOf(double range_sigma_m, double yaw_sigma) {
  RangeBearingScan scan;
  scan.range_sigma_m = range_sigma_m;
  scan.yaw_sigma = yaw_sigma;
  return scan;
}

RangeBearingOptions hidden() {
  RangeBearingOptions options;
  options.use_ids = false;
  return options;
}

/// Whether a robot is found, round and round among posts at random, that starts so far off, with
/// or without a first reading of nothing where a post is expected.
bool findsBack(unsigned seed, double sigma_m, double sigma_heading, bool starts_wrong) {
  Looks looks(seed);
  const auto posts = looks.posts(36);
  Pose2 T_world_robot{0.0, -3.0, 0.0};
  Resumption from = fixedMapOf(posts, 0.03);
  from.T_world_robot = T_world_robot * looks.pose(sigma_m, sigma_heading);
  from.covariance = MapStart::startCovariance(sigma_m, sigma_heading);
  const RangeBearingOptions options = hidden();
  RangeBearingEstimator estimator(options, {}, from);
  if (starts_wrong) {
    RangeBearingScan all = scanOf(0.05, radians(1.0)), scan = all;
    for (const auto& post : posts) looks.look(from.T_world_robot, post, all);
    const auto nearest =
        std::min_element(all.readings.begin(), all.readings.end(),
                         [](const auto& a, const auto& b) { return a.range_m < b.range_m; });
    if (nearest != all.readings.end()) scan.readings.push_back(*nearest);
    estimator.step(0.0, {}, scan);
  }
  const Pose2 way{0.1, 0.0, 0.1 / 3.0};
  MotionIncrement motion;
  motion.covariance = MapStart::startCovariance(0.01, radians(0.5));
  for (int step = 1; step <= 90; ++step) {
    T_world_robot = T_world_robot * way;
    motion.T_previous_robot = way * looks.pose(0.01, radians(0.5));
    RangeBearingScan scan = scanOf(0.05, radians(1.0));
    for (const auto& post : posts) looks.look(T_world_robot, post, scan);
    estimator.step(0.5 * step, motion, scan);
  }
  return (estimator.pose().translation() - T_world_robot.translation()).norm() < 0.3;
}

/// It comes back from where nothing was seen: each post it sees may be one of several, and only
/// many together tell which.
TEST(HiddenIdentities, AreSortedOutFromAStartAMetreOff) {
  int right = 0;
  for (unsigned seed = 0; seed < 60; ++seed) right += findsBack(seed, 1.0, radians(15.0), false);
  EXPECT_GE(right, 46);
}

/// A history in which the first reading was of nothing, and the robot anywhere, outlives the
/// likelier one.
TEST(HiddenIdentities, AreSortedOutAfterAReadingOfNothing) {
  int right = 0;
  for (unsigned seed = 0; seed < 60; ++seed) right += findsBack(seed, 0.5, radians(10.0), true);
  EXPECT_GE(right, 53);
}

/// Which of two is which is not settled by the first of them.
TEST(HiddenIdentities, OfNeighboursAreDecidedTogether) {
  int swapped = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    Looks looks(seed);
    const std::vector<Eigen::Vector2d> posts{{3.0, 0.0}, {3.0, 0.12}};
    Resumption from = fixedMapOf(posts, 0.01);
    from.T_world_robot = looks.pose(0.02, radians(0.5));
    from.covariance = MapStart::startCovariance(0.02, radians(0.5));
    const RangeBearingOptions options = hidden();
    RangeBearingEstimator estimator(options, {}, from);
    RangeBearingScan scan = scanOf(0.08, radians(1.5));
    for (const auto& post : posts) looks.look({}, post, scan, 4.0);
    const auto matches = [&](int first, int second) {
      std::vector<Match> matches;
      for (const int number : {first, second}) {
        const RangeBearing& reading = scan.readings[matches.size()];
        Measurement m;
        m.kind = LandmarkKind::kPillarEdge;
        m.z = Eigen::Vector2d(reading.yaw, reading.range_m);
        m.R = Eigen::Vector2d(scan.yaw_sigma, scan.range_sigma_m).cwiseAbs2().asDiagonal();
        matches.push_back({LandmarkId{number}, m});
      }
      return matches;
    };
    const bool right = *estimator.filter().jointDistance2(matches(1, 2)) <
                       *estimator.filter().jointDistance2(matches(2, 1));
    const auto report = estimator.step(0.5, {}, scan);
    ASSERT_EQ(report.landmarks.size(), 2u);
    if (right && report.landmarks[0] && report.landmarks[1])
      swapped += *report.landmarks[0] == LandmarkId{2};
    else if (right)
      ++swapped;
  }
  EXPECT_LE(swapped, 2);
}

}  // namespace
}  // namespace colonnade
