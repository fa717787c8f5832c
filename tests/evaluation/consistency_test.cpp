// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
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

TEST(CovarianceCsv, ReadsBackWhatItWrote) {
  const auto path = std::filesystem::temp_directory_path() / "colonnade_covariance_test.csv";
  Eigen::Matrix3d P;
  P << 1, 0.1, 0.2, 0.1, 2, -0.3, 0.2, -0.3, 0.123456789012;
  writeCovarianceCsv(path, {{1700000000.25, P}, {1700000000.5, 2.0 * P}});
  const auto rows = readCovarianceCsv(path);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0].stamp_s, 1700000000.25, 1e-6);
  EXPECT_TRUE(rows[1].covariance.isApprox(2.0 * P, 1e-11));
  std::ofstream(path) << "stamp,xx,xy,xphi,yy,yphi,phiphi\n1,1,0,0,1,0\n";
  EXPECT_THAT(readError(path), HasSubstr("colonnade_covariance_test.csv:2: a row has 7 numbers"));
  std::ofstream(path) << "1,1,0,0,1,0,nan\n";
  EXPECT_THAT(readError(path), HasSubstr(":1: \"nan\" is not a number"));
  std::filesystem::remove(path);
  EXPECT_THAT(readError(path), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace colonnade
