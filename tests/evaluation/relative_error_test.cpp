// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Relative errors against the definitions of the TUM RGB-D benchmark (Sturm 2012), in matrices.
#include <gtest/gtest.h>

#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "test_paths.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;

Eigen::Matrix4d motion(const Trajectory& path, std::size_t i, std::size_t j) {
  return path[i].T_world_body.matrix().inverse() * path[j].T_world_body.matrix();
}

/// Root mean square of the translations of (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) for every pair `step`
/// poses apart, forwards or backwards in time, the last `without` poses left out as ends.
double rootMeanError(const Trajectory& estimate, const Trajectory& truth, std::size_t step,
                     bool backwards, std::size_t without) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i + step + without < truth.size(); ++i) {
    const std::size_t a = backwards ? i + step : i;
    const std::size_t b = backwards ? i : i + step;
    const Eigen::Matrix4d error = motion(truth, a, b).inverse() * motion(estimate, a, b);
    sum += error.topRightCorner<3, 1>().squaredNorm();
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

TEST(RelativeError, OverOneSecondIsEquationOneOfThePaper) {
  const auto truth = winding();
  const auto estimate = noisy(truth);
  const auto score = evaluateTrajectory(estimate, truth);
  EXPECT_NEAR(*score.rpe_1s_m, rootMeanError(estimate, truth, 10, false, 0), 1e-9);
}

TEST(RelativeError, OverOneSecondIsAlsoGivenAsTheBenchmarksProgramHasIt) {
  const auto truth = winding();
  const auto estimate = noisy(truth);
  const auto score = evaluateTrajectory(estimate, truth);
  const double program = rootMeanError(estimate, truth, 10, true, 1);
  EXPECT_NEAR(*score.rpe_1s_tum_m, program, 1e-9);
  // They differ: turns of a degree at the end of a metre count there as at its beginning.
  EXPECT_GT(std::abs(program - *score.rpe_1s_m), 1e-5);
}

TEST(RelativeError, OfOneTurnCountsOnceForwardsAndByTheWayBackwards) {
  // Straight for a second, 1 m; the estimate ends at the right place, 0.1 rad turned.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i <= 11; ++i) {
    truth.push_back(at(0.1 * i, 0.1 * i, 0.0, 0.0));
    estimate.push_back(at(0.1 * i, 0.1 * i, 0.0, i == 10 ? 0.1 : 0.0));
  }
  const auto score = evaluateTrajectory(estimate, truth);
  EXPECT_NEAR(*score.rpe_1s_m, 0.0, 1e-9);
  EXPECT_NEAR(*score.rpe_1s_tum_m, 2.0 * std::sin(0.05), 1e-9);
  EXPECT_NEAR(*score.rpe_1s_deg, degrees(0.1) / std::sqrt(2.0), 1e-9);
}

TEST(RelativeError, OverDistanceIsPerMetreOfEachPiece) {
  // Steps of 0.4 m: pieces over 1 m are 1.2 m long. Each step falls 2 cm short: 6 cm of 1.2 m.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i <= 30; ++i) {
    truth.push_back(at(0.1 * i, 0.4 * i, 0.0, 0.0));
    estimate.push_back(at(0.1 * i, 0.38 * i, 0.0, 0.0));
  }
  const auto score = evaluateTrajectory(estimate, truth);
  EXPECT_EQ(score.rpeOver(1.0)->pieces, 28U);
  EXPECT_NEAR(score.rpeOver(1.0)->percent, 5.0, 1e-9);
  EXPECT_NEAR(*score.end_drift_percent, 5.0, 1e-9);
}

}  // namespace
}  // namespace colonnade
