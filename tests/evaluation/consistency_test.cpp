// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/consistency.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;

std::vector<StampedCovariance> constant(const Trajectory& path, const Eigen::Matrix3d& P) {
  std::vector<StampedCovariance> rows;
  for (const auto& pose : path) rows.push_back({pose.stamp_s, P});
  rows.front().covariance.setZero();  // a filter is sure of where it starts
  return rows;
}

std::string readError(const std::filesystem::path& path) {
  try {
    readCovarianceCsv(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Consistency, IsTheHandComputedSquareOverThree) {
  // 0.2 m with sigma 0.1 and 1.5 m with sigma 0.5 and nothing in heading: (4 + 9) / 3.
  const auto truth = straight();
  auto estimate = truth;
  for (std::size_t i = 1; i < estimate.size(); ++i)
    estimate[i].T_world_body.translation() += Eigen::Vector3d(0.2, 1.5, 0.0);
  const Eigen::Matrix3d P = Eigen::Vector3d(0.01, 0.25, 1.0).asDiagonal();
  const auto score = evaluateTrajectory(estimate, truth, {}, constant(estimate, P));
  EXPECT_NEAR(*score.nees_mean, 13.0 / 3.0, 1e-9);
  EXPECT_EQ(score.nees_poses, estimate.size() - 1);
  EXPECT_EQ(*score.nees_share_within_95, 0.0);
}

TEST(Consistency, IsNearOneForHonestNoise) {
  const auto truth = winding();
  auto estimate = noisy(truth);
  estimate.front() = truth.front();
  const Eigen::Matrix3d P = Eigen::Vector3d(4e-4, 4e-4, 0.017 * 0.017).asDiagonal();
  const auto honest = evaluateTrajectory(estimate, truth, {}, constant(estimate, P));
  EXPECT_NEAR(*honest.nees_mean, 1.0, 0.2);
  EXPECT_NEAR(*honest.nees_share_within_95, 0.95, 0.05);
  const auto too_sure = evaluateTrajectory(estimate, truth, {}, constant(estimate, P / 4.0));
  EXPECT_NEAR(*too_sure.nees_mean, 4.0 * *honest.nees_mean, 1e-9);
}

TEST(Consistency, LaysTheFirstPosesOnEachOther) {
  const auto truth = winding();
  const auto estimate = moved(Pose2{5.0, 2.0, -1.0}.toIsometry3(), truth);
  const auto score = evaluateTrajectory(estimate, truth, {},
                                        constant(estimate, Eigen::Matrix3d::Identity() * 1e-4));
  EXPECT_NEAR(*score.nees_mean, 0.0, 1e-12);
}

TEST(Consistency, IsAbsentWithoutUsableCovariances) {
  const auto path = straight();
  EXPECT_FALSE(evaluateTrajectory(path, path).nees_mean);
  const auto flat = constant(path, Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal());
  EXPECT_FALSE(evaluateTrajectory(path, path, {}, flat).nees_mean);
  auto elsewhere = constant(path, Eigen::Matrix3d::Identity());
  for (auto& row : elsewhere) row.stamp_s += 500.0;
  EXPECT_FALSE(evaluateTrajectory(path, path, {}, elsewhere).nees_mean);
}

/// A robot that dead-reckons with honest noise: its error and covariance grow from nothing, in the
/// first step by a tenth of what later ones add.
struct DeadReckoning {
  Trajectory truth;
  Trajectory estimate;
  std::vector<StampedCovariance> covariances;
};

DeadReckoning deadReckoning(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  DeadReckoning run;
  run.truth = winding();
  Pose2 pose = planarPart(run.truth.front().T_world_body);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    if (i > 0) {
      const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(i == 1 ? 0.0004 : 0.004);
      Pose2 step = planarPart(run.truth[i - 1].T_world_body.inverse() * run.truth[i].T_world_body);
      step.x += sigma.x() * noise(random);
      step.y += sigma.y() * noise(random);
      step.phi += sigma.z() * noise(random);
      Eigen::Matrix3d J_pose;
      Eigen::Matrix3d J_step;
      pose = compose(pose, step, &J_pose, &J_step);
      P = J_pose * P * J_pose.transpose() +
          J_step * sigma.cwiseAbs2().asDiagonal() * J_step.transpose();
    }
    run.estimate.push_back({run.truth[i].stamp_s, pose.toIsometry3()});
    run.covariances.push_back({run.truth[i].stamp_s, P});
  }
  return run;
}

/// Covariances are about the world as it was at the start: where it lies by then is told.
TEST(Consistency, IsTheSameWhenTheWorldMovesAlongWithTheMap) {
  for (const Alignment alignment : {Alignment::kSe2, Alignment::kNone}) {
    EvaluationOptions options;
    options.alignment = alignment;
    DeadReckoning run = deadReckoning(7);
    const auto still = evaluateTrajectory(run.estimate, run.truth, options, run.covariances);
    for (std::size_t i = run.estimate.size() / 3; i < run.estimate.size(); ++i) {
      const Pose2 T_new_old{0.4, -0.2, i > run.estimate.size() / 2 ? 0.35 : 0.1};
      StampedCovariance& row = run.covariances[i];
      Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
      R.topLeftCorner<2, 2>() = T_new_old.rotation();
      row.T_world_origin = T_new_old;
      row.covariance = R * row.covariance * R.transpose();
      run.estimate[i].T_world_body = T_new_old.toIsometry3() * run.estimate[i].T_world_body;
    }
    const auto moved = evaluateTrajectory(run.estimate, run.truth, options, run.covariances);
    EXPECT_NEAR(*moved.nees_mean, *still.nees_mean, 1e-9);
    EXPECT_EQ(moved.nees_poses, still.nees_poses);

    // A map lies in the world of the end, or in that of the poses as they are known then.
    const Pose2 T_end = run.covariances.back().T_world_origin;
    const auto where = [](const Anchor& anchor, const Pose2& T_world_estimate) {
      return (anchor.T_truth_estimate * T_world_estimate).vector().eval();
    };
    const auto at_end = anchorOfMap(moved, {}, run.covariances);
    EXPECT_LT((where(*at_end, T_end) - where(*still.anchor, {})).norm(), 1e-9);
    if (alignment == Alignment::kNone) continue;
    const Pose2 T_final{-0.3, 0.1, 0.2};
    const Trajectory final = testing::moved(T_final.toIsometry3(), deadReckoning(7).estimate);
    const auto at_last = anchorOfMap(moved, final, run.covariances);
    EXPECT_LT((where(*at_last, T_final) - where(*still.anchor, {})).norm(), 1e-9);

    const TemporaryFolder folder;
    writeCovarianceCsv(folder / "covariance.csv", run.covariances);
    const auto rows = readCovarianceCsv(folder / "covariance.csv");
    EXPECT_NEAR(rows.back().T_world_origin.phi, 0.35, 1e-12);
  }
}

double meanNees(int late_poses, Alignment alignment = Alignment::kSe2) {
  EvaluationOptions options;
  options.alignment = alignment;
  double sum = 0.0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto run = deadReckoning(seed);
    const Trajectory truth(run.truth.begin() + late_poses, run.truth.end());
    sum += evaluateTrajectory(run.estimate, truth, options, run.covariances).nees_mean.value();
  }
  return sum / 100.0;
}

TEST(Consistency, OfManyHonestRunsLiesInTheBand) {
  const Band band = consistencyBand(100, 3, 0.999);
  EXPECT_GT(meanNees(0), band.low);
  EXPECT_LT(meanNees(0), band.high);
}

TEST(Consistency, OfTruthThatStartsALittleLateIsStillRight) {
  // The rule promises a fifth.
  EXPECT_NEAR(meanNees(1), meanNees(0), 0.2 * meanNees(0));
  EXPECT_NE(meanNees(1), meanNees(0));
}

TEST(Consistency, IsRefusedWithAReasonWhenTruthStartsTooLate) {
  const auto run = deadReckoning(1);
  const Trajectory truth(run.truth.begin() + 60, run.truth.end());
  const auto score = evaluateTrajectory(run.estimate, truth, {}, run.covariances);
  EXPECT_FALSE(score.nees_mean);
  EXPECT_EQ(score.nees_poses, 0U);
  EXPECT_THAT(score.nees_refused, HasSubstr("6.00 s after its beginning"));
  EXPECT_THAT(score.nees_refused, HasSubstr("--align none"));
}

TEST(Consistency, NeedsNoAnchorWhereBothAreInOneWorld) {
  // The poses of late truth are the later, surer ones of the same honest runs.
  const Band band = consistencyBand(100, 3, 0.999);
  EXPECT_GT(meanNees(60, Alignment::kNone), band.low);
  EXPECT_LT(meanNees(60, Alignment::kNone), band.high);
}

TEST(Consistency, IsRefusedWhereTheFirstCovarianceIsMissing) {
  auto run = deadReckoning(1);
  run.covariances.erase(run.covariances.begin());
  const auto score = evaluateTrajectory(run.estimate, run.truth, {}, run.covariances);
  EXPECT_FALSE(score.nees_mean);
  EXPECT_THAT(score.nees_refused, HasSubstr("no covariance at 0.000 s"));
}

TEST(CovarianceCsv, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  const auto path = folder / "covariance.csv";
  Eigen::Matrix3d P;
  P << 1, 0.1, 0.2, 0.1, 2, -0.3, 0.2, -0.3, 0.123456789012;
  writeCovarianceCsv(path, {{1700000000.25, P}, {1700000000.5, 2.0 * P}});
  const auto rows = readCovarianceCsv(path);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0].stamp_s, 1700000000.25, 1e-6);
  EXPECT_TRUE(rows[1].covariance.isApprox(2.0 * P, 1e-11));
  std::ofstream(path) << "stamp,xx,xy,xphi,yy,yphi,phiphi,origin_x\n1,1,0,0,1,0,1,0\n";
  EXPECT_THAT(readError(path), HasSubstr("covariance.csv:2: columns origin_x,origin_y,origin_phi"));
  std::ofstream(path) << "stamp,xx,xy,xphi,yy,yphi,phiphi\n1,1,0,0,1,0\n";
  EXPECT_THAT(readError(path), HasSubstr("covariance.csv:2: the header has 7 columns, this row 6"));
  std::ofstream(path) << "stamp,xx,xy,xphi,yy,yphi,phiphi\n1,1,0,0,1,0,nan\n";
  EXPECT_THAT(readError(path), HasSubstr(":2: column phiphi: \"nan\" is not a number"));
  std::filesystem::remove(path);
  EXPECT_THAT(readError(path), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace colonnade
