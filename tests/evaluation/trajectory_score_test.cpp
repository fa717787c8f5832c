// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/trajectory_score.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/evaluation/score_json.hpp"
#include "test_paths.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;

EvaluationOptions with(Alignment alignment) {
  EvaluationOptions options;
  options.alignment = alignment;
  return options;
}

std::string errorOf(const Trajectory& estimate, const Trajectory& truth) {
  try {
    evaluateTrajectory(estimate, truth);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TrajectoryScore, ErrorsWithoutAlignmentAreTheDistances) {
  // Errors of 0.3, 0 and 0.4 m: root mean square sqrt(0.25 / 3).
  const Trajectory truth = {at(0, 0, 0, 0), at(0.1, 1, 0, 0), at(0.2, 2, 0, 0)};
  const Trajectory estimate = {at(0, 0, 0.3, 0), at(0.1, 1, 0, radians(3)), at(0.2, 2, -0.4, 0)};
  const auto score = evaluateTrajectory(estimate, truth, with(Alignment::kNone));
  EXPECT_NEAR(score.ate_rmse_m, std::sqrt(0.25 / 3.0), 1e-12);
  EXPECT_NEAR(score.ate_max_m, 0.4, 1e-12);
  EXPECT_NEAR(score.heading_rmse_deg, std::sqrt(3.0), 1e-9);
  EXPECT_EQ(score.matched, 3U);
  EXPECT_NEAR(score.path_length_m, 2.0, 1e-12);
}

TEST(TrajectoryScore, PlanarFitOfACrossIsTheHandComputedOne) {
  // Four points of a cross, the estimate 10 % too large: a rigid fit cannot shrink it, so each
  // point keeps an error of 0.1 m.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 4; ++i) {
    const double angle = kPi / 2.0 * i;
    truth.push_back(at(0.1 * i, std::cos(angle), std::sin(angle), 0.0));
    estimate.push_back(
        at(0.1 * i, 5.0 + 1.1 * std::cos(angle + 0.4), 2.0 + 1.1 * std::sin(angle + 0.4), 0.4));
  }
  for (const auto alignment : {Alignment::kSe2, Alignment::kSe3}) {
    const auto score = evaluateTrajectory(estimate, truth, with(alignment));
    EXPECT_NEAR(score.ate_rmse_m, 0.1, 1e-7) << name(alignment);
    EXPECT_NEAR(score.heading_rmse_deg, 0.0, 1e-5) << name(alignment);
  }
}

TEST(TrajectoryScore, AgreesWithUmeyamaWithoutScale) {
  const auto truth = winding();
  const auto estimate = noisy(truth);
  Eigen::Matrix3Xd p(3, 201);
  Eigen::Matrix3Xd q(3, 201);
  for (int i = 0; i < 201; ++i) {
    p.col(i) = estimate[static_cast<std::size_t>(i)].T_world_body.translation();
    q.col(i) = truth[static_cast<std::size_t>(i)].T_world_body.translation();
  }
  const Eigen::Matrix4d T = Eigen::umeyama(p, q, false);
  const Eigen::Matrix3Xd aligned = (T.topLeftCorner<3, 3>() * p).colwise() + T.col(3).head<3>();
  const double rmse = std::sqrt((aligned - q).colwise().squaredNorm().mean());
  for (const auto alignment : {Alignment::kSe2, Alignment::kSe3})
    EXPECT_NEAR(evaluateTrajectory(estimate, truth, with(alignment)).ate_rmse_m, rmse, 1e-8);
}

TEST(TrajectoryScore, DoesNotChangeWhenTheWholeEstimateMoves) {
  const auto truth = winding();
  const auto estimate = noisy(truth);
  const auto here = evaluateTrajectory(estimate, truth, with(Alignment::kSe2));
  const auto there = evaluateTrajectory(moved(Pose2{30.0, -7.0, 2.5}.toIsometry3(), estimate),
                                        truth, with(Alignment::kSe2));
  EXPECT_NEAR(here.ate_rmse_m, there.ate_rmse_m, 1e-9);
  EXPECT_NEAR(here.heading_rmse_deg, there.heading_rmse_deg, 1e-6);
  EXPECT_NEAR(here.rpeOver(1.0)->percent, there.rpeOver(1.0)->percent, 1e-9);

  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  motion.translation() << 1, 2, 3;
  const auto anywhere = evaluateTrajectory(moved(motion, estimate), truth, with(Alignment::kSe3));
  EXPECT_NEAR(anywhere.ate_rmse_m,
              evaluateTrajectory(estimate, truth, with(Alignment::kSe3)).ate_rmse_m, 1e-9);
  EXPECT_TRUE(anywhere.T_truth_estimate.isApprox(
      evaluateTrajectory(estimate, truth, with(Alignment::kSe3)).T_truth_estimate *
          motion.inverse(),
      1e-6));
}

TEST(TrajectoryScore, NeverFitsAScale) {
  auto estimate = straight();
  for (auto& pose : estimate) pose.T_world_body.translation() *= 1.05;
  const auto score = evaluateTrajectory(estimate, straight(), with(Alignment::kSe2));
  // Errors of 0.05 (x - 10) for x from 0 to 20 in steps of 0.1.
  EXPECT_NEAR(score.ate_rmse_m, 0.05 * 0.1 * std::sqrt((201.0 * 201.0 - 1.0) / 12.0), 1e-9);
  for (const double length : {1.0, 2.0, 5.0, 10.0})
    EXPECT_NEAR(score.rpeOver(length)->percent, 5.0, 1e-6);
  EXPECT_NEAR(*score.rpe_1s_m, 0.05, 1e-9);
  EXPECT_NEAR(*score.end_drift_percent, 5.0, 1e-6);
  EXPECT_NEAR(score.heading_rmse_deg, 0.0, 1e-6);  // a straight path does not roll over
}

TEST(TrajectoryScore, TurningTooMuchShowsInDegreesAMetre) {
  Trajectory estimate;
  Pose2 pose;
  for (int i = 0; i <= 200; ++i) {
    estimate.push_back({0.1 * i, pose.toIsometry3()});
    pose = pose * Pose2{0.1, 0.0, radians(0.05)};
  }
  const auto score = evaluateTrajectory(estimate, straight());
  EXPECT_NEAR(score.rpeOver(1.0)->deg_per_m, 0.5, 1e-6);
  EXPECT_NEAR(score.rpeOver(10.0)->deg_per_m, 0.5, 1e-6);
  EXPECT_NEAR(*score.rpe_1s_deg, 0.5, 1e-6);
}

TEST(TrajectoryScore, StandingStillIsAlignedByOrientation) {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 20; ++i) {
    truth.push_back(at(0.1 * i, 2, 1, 0.5));
    estimate.push_back(at(0.1 * i, 0, 0, 0));
  }
  for (const auto alignment : {Alignment::kSe2, Alignment::kSe3}) {
    const auto score = evaluateTrajectory(estimate, truth, with(alignment));
    EXPECT_NEAR(score.ate_rmse_m, 0.0, 1e-9);
    EXPECT_NEAR(score.heading_rmse_deg, 0.0, 1e-6);
    EXPECT_FALSE(score.end_drift_percent);
    EXPECT_TRUE(score.rpe.empty());
  }
}

TEST(TrajectoryScore, InterpolatesTruthAtTheStampAndAcrossTheHalfTurn) {
  const Trajectory truth = {at(0.0, 0, 0, radians(178)), at(0.1, 0.2, 0.4, radians(-178))};
  const Trajectory estimate = {at(0.025, 0.05, 0.1, radians(179)),
                               at(0.075, 0.15, 0.3, radians(-179))};
  const auto score = evaluateTrajectory(estimate, truth, with(Alignment::kNone));
  EXPECT_NEAR(score.ate_rmse_m, 0.0, 1e-12);
  EXPECT_NEAR(score.heading_rmse_deg, 0.0, 1e-9);
}

TEST(TrajectoryScore, DoesNotBridgeGapsOfTheTruth) {
  auto truth = straight();
  truth.erase(truth.begin() + 51, truth.begin() + 100);  // 5.0 to 10.0 s
  auto estimate = straight();
  for (auto& pose : estimate) pose.stamp_s += 0.05;
  for (auto& pose : estimate)
    if (pose.stamp_s > 5.0 && pose.stamp_s < 10.0) pose.T_world_body.translation().y() = 100.0;
  for (auto& pose : estimate) pose.T_world_body.translation().x() += 0.05;
  const auto score = evaluateTrajectory(estimate, truth, with(Alignment::kNone));
  EXPECT_NEAR(score.ate_rmse_m, 0.0, 1e-9);
  EXPECT_EQ(score.matched, 150U);  // 50 in the gap and the one after the end are not
  EXPECT_EQ(score.estimated, 201U);
  EXPECT_NEAR(score.coverage, (4.9 + 9.9) / 20.0, 1e-6);
  EXPECT_NEAR(score.path_length_m, 4.9 + 9.9, 1e-6);
  // No piece of 10 m fits into either run.
  EXPECT_NE(score.rpeOver(5.0), nullptr);
  EXPECT_EQ(score.rpeOver(10.0), nullptr);
}

TEST(TrajectoryScore, TakesSparseTruthAtItsOwnStamps) {
  Trajectory truth;
  for (const auto& pose : straight())
    if (truth.empty() || pose.stamp_s > truth.back().stamp_s + 0.65) truth.push_back(pose);
  const auto score = evaluateTrajectory(straight(), truth);
  EXPECT_EQ(score.matched, truth.size());
  EXPECT_NE(score.rpeOver(2.0), nullptr);
}

TEST(TrajectoryScore, SaysHowFarTheTimeSpansAgree) {
  // Truth from 2 to 25 s, the estimate from 0 to 20 s.
  auto truth = straight();
  for (int i = 201; i <= 250; ++i) truth.push_back(at(0.1 * i, 0.1 * i, 0.0, 0.0));
  truth.erase(truth.begin(), truth.begin() + 20);
  const auto span = evaluateTrajectory(straight(), truth).span;
  EXPECT_NEAR(span.truth_starts_after_s, 2.0, 1e-9);
  EXPECT_NEAR(span.truth_ends_before_s, -5.0, 1e-9);
  EXPECT_NEAR(span.estimate_in_truth, 0.9, 1e-9);
  EXPECT_NEAR(span.truth_in_estimate, 18.0 / 23.0, 1e-9);
  EXPECT_EQ(toText(span),
            "truth covers 90 % of the estimate (begins 2.00 s after it, ends 5.00 s after it); the "
            "estimate covers 78 % of the truth");
}

TEST(TrajectoryScore, RefusesWhatDoesNotOverlapAndNamesBothSpans) {
  auto late = straight();
  for (auto& pose : late) pose.stamp_s += 1000.0;
  EXPECT_THAT(errorOf(late, straight()), HasSubstr("do not overlap"));
  EXPECT_THAT(errorOf(late, straight()), HasSubstr("estimate spans 1000.000 to 1020.000 s"));
  EXPECT_THAT(errorOf(late, straight()), HasSubstr("truth 0.000 to 20.000 s"));
  EXPECT_THAT(errorOf({}, straight()), HasSubstr("estimated trajectory holds no pose"));
  EXPECT_THAT(errorOf(straight(), {}), HasSubstr("ground truth holds no pose"));
  const Trajectory sparse = {at(0.0, 0, 0, 0), at(20.0, 20, 0, 0)};
  EXPECT_THAT(errorOf({at(7.0, 7, 0, 0)}, sparse), HasSubstr("gaps above 0.1 s"));
}

TEST(TrajectoryScore, OnePoseIsEnoughToHaveAScore) {
  const auto score = evaluateTrajectory({at(3.0, 1, 1, 1)}, straight());
  EXPECT_EQ(score.matched, 1U);
  EXPECT_NEAR(score.ate_rmse_m, 0.0, 1e-9);
  EXPECT_EQ(score.coverage, 0.0);
}

TEST(TrajectoryScore, KnowsItsAlignmentsByName) {
  EXPECT_EQ(alignmentOfName("se3"), Alignment::kSe3);
  EXPECT_THROW(alignmentOfName("sim3"), Error);
}

}  // namespace
}  // namespace colonnade
