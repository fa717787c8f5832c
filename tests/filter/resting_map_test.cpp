// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <map>
#include <random>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/covariance.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {
namespace {

/// A robot goes round a ring of posts and walls with a building axis; several filters are given the
/// same readings. Posts of every fifth place are seen as bearings first, and settle later.
class Ring {
 public:
  Ring(std::vector<FilterOptions> options, double motion_noise = 1.0)
      : motion_noise_(motion_noise) {
    for (const FilterOptions& o : options) filters.emplace_back(o);
    axes_.resize(filters.size());
    known_.resize(filters.size());
    for (int i = 0; i < kPosts; ++i) {
      const double angle = 2.0 * kPi * i / kPosts;
      const double radius = i % 2 == 0 ? kRadius_m - 1.5 : kRadius_m + 1.5;
      posts_.emplace_back(radius * std::sin(angle), kRadius_m - radius * std::cos(angle));
    }
  }

  void step() {
    const Pose2 u{kStep_m, 0.0, kStep_m / kRadius_m};
    const Eigen::Vector3d sigma = motion_noise_ * Eigen::Vector3d(0.02, 0.005, radians(0.7));
    truth_ = truth_ * Pose2{u.x + sigma(0) * normal(), u.y + sigma(1) * normal(),
                            u.phi + sigma(2) * normal()};
    for (EkfSlam& filter : filters) filter.predict(u, sigma.cwiseAbs2().asDiagonal());
    std::map<int, Measurement> seen;
    for (int i = 0; i < kPosts; ++i) {
      Measurement m = reading(i % 5 == 0 ? LandmarkKind::kPillarEdge : LandmarkKind::kDepthSlope,
                              BlockKind::kPoint, posts_[static_cast<std::size_t>(i)]);
      if (m.z(1) > 4.0) continue;
      if (i % 5 == 0) {  // bearing only
        m.z = Eigen::VectorXd(m.z.head(1));
        m.R = Eigen::MatrixXd(m.R.topLeftCorner(1, 1));
      }
      seen[i] = m;
    }
    for (int i = 0; i < 8; ++i) {  // walls: tangents of the ring
      const double angle = 2.0 * kPi * i / 8.0;
      const Eigen::Vector4d wall(kRadius_m * std::sin(angle), kRadius_m * (1.0 - std::cos(angle)),
                                 angle - kPi / 2.0, 2.0);
      if ((wall.head<2>() - truth_.translation()).norm() < 3.0)
        seen[100 + i] = reading(LandmarkKind::kFloorEdge, BlockKind::kFloorLine, wall);
    }
    const double wall_direction = wrapAngle(0.3 - truth_.phi) + radians(1.0) * normal();
    for (std::size_t f = 0; f < filters.size(); ++f) give(f, seen, wall_direction);
    ++steps;
  }

  static constexpr int kPosts = 40;
  static constexpr double kRadius_m = 8.0;
  static constexpr double kStep_m = 0.2;
  static constexpr int kStepsAround = static_cast<int>(2.0 * kPi * kRadius_m / kStep_m);

  std::vector<EkfSlam> filters;
  int steps = 0;
  double nees(const EkfSlam& filter) const {
    Eigen::Vector3d e = filter.pose().vector() - truth_.vector();
    e(2) = wrapAngle(e(2));
    return e.dot(filter.poseCovariance().ldlt().solve(e)) / 3.0;
  }

 private:
  double normal() { return normal_(random_); }

  Measurement reading(LandmarkKind kind, BlockKind block_kind, const BlockVector& block) {
    const Eigen::Vector2d sigma(radians(1.0), 0.05);
    Measurement m;
    m.kind = kind;
    m.z = Eigen::Vector2d(0.0, 1.0);
    m.R = sigma.cwiseAbs2().asDiagonal();
    m.z = predictMeasurement(truth_, block_kind, block, m).z;
    m.z += Eigen::Vector2d(sigma(0) * normal(), sigma(1) * normal());
    m.z(0) = wrapAngle(m.z(0));
    return m;
  }

  void give(std::size_t f, const std::map<int, Measurement>& seen, double wall_direction) {
    EkfSlam& filter = filters[f];
    auto& known = known_[f];
    std::vector<LandmarkId> needed;
    for (const auto& [key, m] : seen)
      if (const auto at = known.find(key); at != known.end()) needed.push_back(at->second);
    filter.focus(needed);
    if (!axes_[f])
      axes_[f] = filter.addAxis(wall_direction, radians(1.0));
    else
      filter.updateAxis(*axes_[f], wall_direction, radians(1.0));
    std::vector<Match> matches;
    for (const auto& [key, m] : seen)
      if (const auto at = known.find(key); at != known.end()) matches.push_back({at->second, m});
    filter.update(matches);
    for (const auto& [key, m] : seen) {
      if (known.count(key)) continue;
      std::optional<LandmarkId> id;
      if (m.hasRange()) {
        id = filter.addLandmark(m);
      } else {
        const LandmarkId clone = filter.addPoseClone();
        id = filter.addLandmarkOnRay(clone, m, 0.4, 0.2);
        filter.remove(clone);
      }
      if (id) known[key] = *id;
    }
    filter.settleInverseDepths();
    if (steps == 150) {  // one goes for good
      filter.remove(known.at(1));
      known.erase(1);
    }
  }

  double motion_noise_;
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::vector<Eigen::Vector2d> posts_;
  std::vector<std::map<int, LandmarkId>> known_;
  std::vector<std::optional<LandmarkId>> axes_;
  Pose2 truth_;
};

FilterOptions withActive(int active_landmarks, bool invariant) {
  FilterOptions options;
  options.active_landmarks = active_landmarks;
  options.invariant = invariant;
  options.negligible_gain = 0.0;
  options.gate_probability = 0.999999;
  return options;
}

/// The largest differences of values and, relative to the deviations, of covariances.
std::pair<double, double> difference(const State& a, const State& b) {
  if (a.x.size() != b.x.size()) return {HUGE_VAL, HUGE_VAL};
  const Eigen::VectorXd scale = b.P.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  return {(a.x - b.x).cwiseAbs().maxCoeff(),
          (scale.asDiagonal() * (a.P - b.P) * scale.asDiagonal()).cwiseAbs().maxCoeff()};
}

TEST(RestingMap, WithThePlainFilterItIsTheFullFilter) {
  Ring ring({withActive(0, false), withActive(6, false)});
  bool rested = false;
  for (int i = 0; i < 2 * Ring::kStepsAround + 40; ++i) {
    ring.step();
    rested |= ring.filters[1].state().x.size() < ring.filters[0].state().x.size() / 2;
    if (i % 10 != 0) continue;
    const auto [values, covariances] =
        difference(ring.filters[1].fullState(), ring.filters[0].state());
    ASSERT_LT(values, 1e-9) << "step " << i;
    ASSERT_LT(covariances, 1e-9) << "step " << i;
  }
  EXPECT_TRUE(rested);
}

TEST(RestingMap, WithTransportItDiffersInSecondOrder) {
  Ring ring({withActive(0, true), withActive(6, true)});
  for (int i = 0; i < 2 * Ring::kStepsAround; ++i) {
    ring.step();
    const Eigen::Vector3d apart = ring.filters[1].pose().vector() - ring.filters[0].pose().vector();
    const Eigen::Vector3d sigma = ring.filters[0].poseCovariance().diagonal().cwiseSqrt();
    ASSERT_LT((apart.array().abs() / sigma.array()).maxCoeff(), 0.1) << "step " << i;
  }
  EXPECT_NEAR(ring.nees(ring.filters[1]), ring.nees(ring.filters[0]), 0.1);
}

/// Nobody observes the direction of the whole world without an axis: with a start of known
/// uncertainty and without noise of motion, the information along G(x) stays that of the start.
TEST(RestingMap, GainsNoInformationAboutADirectionNobodyObserves) {
  Ring ring({withActive(6, true)}, 0.0);
  EkfSlam& filter = ring.filters[0];
  filter.placeRobot({}, Eigen::Vector3d(1e-2, 1e-2, 4e-4).asDiagonal());
  for (int i = 0; i < Ring::kStepsAround + 60; ++i) {
    ring.step();
    if (i % 20 != 0) continue;
    const State state = filter.fullState();
    const Eigen::VectorXd G = worldTurn(state);
    EXPECT_NEAR(1.0 / 4e-4, G.dot(state.P.ldlt().solve(G)), 5.0) << "step " << i;
  }
}

TEST(RestingMap, StaysSoundAndShowsEveryLandmark) {
  Ring ring({withActive(6, true), withActive(0, true)});
  for (int i = 0; i < Ring::kStepsAround; ++i) ring.step();
  const State state = ring.filters[0].fullState();
  ASSERT_TRUE(state.P.allFinite());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(state.P);
  EXPECT_GT(eigen.eigenvalues()(0), -1e-9 * eigen.eigenvalues().tail(1)(0));
  EXPECT_EQ(ring.filters[1].landmarkMap().size(), ring.filters[0].landmarkMap().size());
  EXPECT_LT(ring.filters[0].state().blocks.size(), 20u);
}

TEST(RestingMap, WakingAllOfItChangesNothingElse) {
  Ring ring({withActive(6, true)});
  for (int i = 0; i < Ring::kStepsAround; ++i) ring.step();
  EkfSlam& filter = ring.filters[0];
  const State before = filter.fullState();
  ASSERT_LT(filter.state().blocks.size(), before.blocks.size());
  filter.wakeAll();
  EXPECT_EQ(filter.state().x, before.x);
  EXPECT_EQ(filter.state().P, before.P);
  for (const Block& block : before.blocks) EXPECT_FALSE(filter.isResting(block.id));
}

Measurement readingOf(const EkfSlam& filter, const State& state, const Block& block) {
  Measurement m;
  m.kind = block.landmark_kind;
  m.z = Eigen::Vector2d(0.0, 1.0);
  m.R = Eigen::Vector2d(1e-4, 1e-3).asDiagonal();
  m.z = predictMeasurement(filter.pose(), block.block_kind, state.values(block), m).z;
  return m;
}

TEST(RestingMap, ARestingLandmarkIsFoundByItsReading) {
  Ring ring({withActive(6, true)});
  for (int i = 0; i < Ring::kStepsAround / 2; ++i) ring.step();
  const EkfSlam& filter = ring.filters[0];
  std::size_t found = 0, resting = 0;
  const State all = filter.fullState();
  for (const Block& block : all.blocks) {
    if (block.block_kind != BlockKind::kPoint || !filter.isResting(block.id)) continue;
    const Measurement m = readingOf(filter, all, block);
    const auto near = filter.restingNear({&m, 1});
    ++resting;
    found += std::count(near.begin(), near.end(), block.id) == 1 ? 1 : 0;
    EXPECT_LT(near.size(), 6u);
  }
  EXPECT_GT(resting, 5u);
  EXPECT_EQ(resting, found);
}

TEST(RestingMap, AllThatIsReadIsActiveAfterwards) {
  Ring ring({withActive(6, true)});
  for (int i = 0; i < Ring::kStepsAround / 2; ++i) ring.step();
  const State all = ring.filters[0].fullState();
  int woken = 0;
  for (const Block& block : all.blocks) {
    if (block.block_kind != BlockKind::kPoint || !ring.filters[0].isResting(block.id)) continue;
    EkfSlam filter = ring.filters[0];
    std::vector<LandmarkId> read{block.id};
    std::vector<Measurement> readings{readingOf(filter, all, block)};
    for (const Block& active : filter.state().blocks) {
      if (active.block_kind != BlockKind::kPoint) continue;
      read.push_back(active.id);
      readings.push_back(readingOf(filter, filter.state(), active));
    }
    filter.focus({}, readings);
    for (const LandmarkId id : read) EXPECT_FALSE(filter.isResting(id));
    ++woken;
  }
  EXPECT_GT(woken, 5);
}

/// What is left out makes the covariance of all larger by something positive semidefinite, and no
/// variance by more than the share allowed.
TEST(RestingMap, LeavesOutOnlyWhatIsNegligible) {
  constexpr int kPoints = 60, kActive = 12;
  constexpr double kShare = 0.05;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  State state;
  std::vector<LandmarkId> all, first, second;
  for (int i = 0; i < kPoints; ++i) {
    all.push_back(LandmarkId{i});
    if (i < kActive) first.push_back(all.back());
    if (i >= kActive && i < 2 * kActive) second.push_back(all.back());
    state.blocks.push_back(
        {all.back(), BlockKind::kPoint, LandmarkKind::kDepthSlope, 3 + 2 * i, {}});
  }
  const int n = 3 + 2 * kPoints;
  // Neighbours are alike: correlation falls with the distance in the order.
  state.x = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
  state.P = Eigen::MatrixXd::NullaryExpr(n, n, [](Eigen::Index r, Eigen::Index c) {
    const auto apart = static_cast<double>(std::abs(r - c));
    return std::exp(-0.02 * apart) + std::exp(-0.1 * apart) + std::exp(-0.4 * apart) +
           (r == c ? 0.1 : 0.0);
  });
  RestingMap exact;
  exact.exchange(state, first, false, 0.0);
  for (int i = 0; i < kActive; ++i) {
    Eigen::MatrixXd H(1, 2);
    H << normal(random), normal(random);
    const auto correction = SparseJacobian(1).add(0, 3 + 2 * i, H);
    ASSERT_TRUE(correct(state, correction, Eigen::VectorXd::Constant(1, 0.1),
                        Eigen::MatrixXd::Constant(1, 1, 0.5), false, 0));
  }
  RestingMap loose = exact;
  State exact_state = state, loose_state = state;
  exact.exchange(exact_state, second, false, 0.0);
  loose.exchange(loose_state, second, false, kShare);
  exact.exchange(exact_state, all, false, 0.0);
  loose.exchange(loose_state, all, false, 0.0);
  EXPECT_EQ(0.0, (exact_state.x - loose_state.x).cwiseAbs().maxCoeff());
  const Eigen::MatrixXd more = loose_state.P - exact_state.P;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(more);
  EXPECT_GT(eigen.eigenvalues()(0), -1e-12);
  EXPECT_GT(eigen.eigenvalues().tail(1)(0), 1e-6) << "nothing was left out";
  EXPECT_LT(more.diagonal().maxCoeff(), kShare * 3.1);
}

}  // namespace
}  // namespace colonnade
