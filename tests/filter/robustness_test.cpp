// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {
namespace {

/// Finite, symmetric to the bit, and positive semidefinite but for rounding.
void expectSound(const State& state) {
  ASSERT_TRUE(state.x.allFinite());
  ASSERT_TRUE(state.P.allFinite());
  EXPECT_EQ(0.0, (state.P - state.P.transpose()).cwiseAbs().maxCoeff());
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(state.P, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GE(eigenvalues.minCoeff(), -1e-9 * eigenvalues.maxCoeff());
}

constexpr double kMotionSigma = 0.01;

/// A robot on a circle of posts. The motion it is told is noisy; `sigma` is the stated and the real
/// noise of ranges (metres) and bearings (radians).
class Ring {
 public:
  explicit Ring(double sigma) : sigma_(sigma) {
    for (int i = 0; i < 12; ++i)
      posts_.emplace_back(5.0 * std::cos(kPi * i / 6.0), 3.0 + 5.0 * std::sin(kPi * i / 6.0));
    ids_.resize(posts_.size());
  }

  template <class Spoil>
  void step(EkfSlam& filter, Spoil spoil) {
    const Pose2 way{0.15, 0.0, 0.05};
    truth_ = truth_ * way;
    EXPECT_TRUE(
        filter.predict({way.x + kMotionSigma * normal(), way.y + kMotionSigma * normal(),
                        way.phi + kMotionSigma * normal()},
                       Eigen::Vector3d::Constant(kMotionSigma * kMotionSigma).asDiagonal()));
    std::vector<Match> matches;
    for (std::size_t i = 0; i < posts_.size(); ++i) {
      const Eigen::Vector2d p = transform(truth_.inverse(), posts_[i]);
      if (p.norm() > 7.0) continue;
      Measurement m;
      m.kind = LandmarkKind::kDepthSlope;
      m.z = Eigen::Vector2d(wrapAngle(std::atan2(p.y(), p.x()) + sigma_ * normal()),
                            p.norm() + sigma_ * normal());
      m.R = Eigen::Matrix2d::Identity() * sigma_ * sigma_;
      if (ids_[i])
        matches.push_back({*ids_[i], m});
      else
        ids_[i] = filter.addLandmark(m);
    }
    spoil(matches);
    filter.update(matches);
    const double error = (filter.pose().translation() - truth_.translation()).norm();
    worst_m_ = std::max(worst_m_, error);
    sum2_ += error * error;
    ++steps_;
  }
  double worst_m() const { return worst_m_; }
  double rmse_m() const { return std::sqrt(sum2_ / steps_); }

 private:
  double normal() { return normal_(random_); }
  double sigma_;
  std::mt19937_64 random_{5};
  std::normal_distribution<double> normal_;
  std::vector<Eigen::Vector2d> posts_;
  std::vector<std::optional<LandmarkId>> ids_;
  Pose2 truth_;
  double worst_m_ = 0.0;
  double sum2_ = 0.0;
  int steps_ = 0;
};

const auto kAsIs = [](std::vector<Match>&) {};

FilterOptions wideGate(bool invariant) {
  FilterOptions options;
  options.invariant = invariant;
  options.gate_probability = 0.999999;
  return options;
}

TEST(Robustness, MeasurementsWithoutNoiseAreFollowed) {
  for (const bool invariant : {true, false}) {
    EkfSlam filter(wideGate(invariant));
    Ring ring(0.0);
    for (int i = 0; i < 250; ++i) ring.step(filter, kAsIs);
    expectSound(filter.state());
    // The first pose is a guess from odometry; after it nothing may be lost.
    EXPECT_LT(ring.worst_m(), 0.1) << (invariant ? "invariant" : "plain");
  }
}

TEST(Robustness, OneLandmarkSeenManyTimesInAFrameStaysSound) {
  EkfSlam filter(wideGate(true));
  Ring ring(0.02);
  for (int i = 0; i < 60; ++i)
    ring.step(filter, [](std::vector<Match>& matches) {
      if (!matches.empty()) matches.insert(matches.end(), 20, matches.front());
    });
  expectSound(filter.state());
  EXPECT_LT(ring.worst_m(), 0.3);
}

TEST(Robustness, SwappedIdentitiesAreRefused) {
  Ring clean_ring(0.02), ring(0.02);
  EkfSlam clean(wideGate(true)), filter(wideGate(true));
  int frames = 0;
  for (int i = 0; i < 250; ++i) {
    clean_ring.step(clean, kAsIs);
    ring.step(filter, [&](std::vector<Match>& matches) {
      if (++frames % 5 == 0 && matches.size() > 1)
        std::swap(matches[0].landmark, matches[1].landmark);
    });
  }
  expectSound(filter.state());
  EXPECT_LT(ring.rmse_m(), 1.5 * clean_ring.rmse_m());
}

TEST(Robustness, AbsurdRangesChangeNoBit) {
  EkfSlam filter(wideGate(true));
  Ring ring(0.02);
  for (int i = 0; i < 40; ++i) ring.step(filter, kAsIs);
  const State before = filter.state();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double range : {std::nan(""), infinity, -infinity, -1.0, 0.0, 1e30, -1e30, 1e300}) {
    Measurement m;
    m.kind = LandmarkKind::kDepthSlope;
    m.z = Eigen::Vector2d(0.1, range);
    m.R = Eigen::Matrix2d::Identity() * 4e-4;
    const Match match{before.blocks.front().id, m};
    EXPECT_FALSE(filter.update({&match, 1}).front()) << range;
    EXPECT_TRUE(before.x == filter.state().x && before.P == filter.state().P) << range;
    EXPECT_FALSE(filter.addLandmark(m)) << range;
    EXPECT_TRUE(before.x.size() == filter.state().x.size() && before.x == filter.state().x)
        << range;
  }
}

}  // namespace
}  // namespace colonnade
