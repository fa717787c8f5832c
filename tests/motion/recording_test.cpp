// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/frames/tum_import.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "shared_data.hpp"
#include "temporary_folder.hpp"

namespace colonnade {
namespace {

struct Result {
  int frames = 0;
  int failures = 0;
  int matched = 0;
  double ate_rmse_m = 0.0;  ///< after the best rigid fit in x, y, yaw
  double nees = 0.0;        ///< of the motion over 15 frames, divided by 3
};

std::optional<Pose2> interpolated(const Trajectory& truth, double stamp_s) {
  for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
    const double dt_s = truth[i + 1].stamp_s - truth[i].stamp_s;
    if (stamp_s < truth[i].stamp_s - 1e-3 || stamp_s > truth[i + 1].stamp_s + 1e-3) continue;
    const double a = (stamp_s - truth[i].stamp_s) / dt_s;
    if (dt_s > 0.1 && a > 1e-2 && a < 0.99) return std::nullopt;
    const Pose2 from = planarPart(truth[i].T_world_body);
    const Pose2 to = planarPart(truth[i + 1].T_world_body);
    return Pose2{from.x + a * (to.x - from.x), from.y + a * (to.y - from.y),
                 wrapAngle(from.phi + a * wrapAngle(to.phi - from.phi))};
  }
  return std::nullopt;
}

double alignedRmse(const std::vector<Pose2>& estimate,
                   const std::vector<std::optional<Pose2>>& truth) {
  Eigen::Vector2d mean_e = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_t = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i]) continue;
    mean_e += estimate[i].translation();
    mean_t += truth[i]->translation();
    count += 1.0;
  }
  mean_e /= count;
  mean_t /= count;
  double sine = 0.0;
  double cosine = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i]) continue;
    const Eigen::Vector2d e = estimate[i].translation() - mean_e;
    const Eigen::Vector2d t = truth[i]->translation() - mean_t;
    cosine += e.dot(t);
    sine += e.x() * t.y() - e.y() * t.x();
  }
  const Eigen::Rotation2Dd R(std::atan2(sine, cosine));
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i]) continue;
    sum += (R * (estimate[i].translation() - mean_e) - (truth[i]->translation() - mean_t))
               .squaredNorm();
  }
  return std::sqrt(sum / count);
}

/// What `run` does before the filter, over a recording imported as a user would, or over one frame
/// in so many of it.
Result track(const std::filesystem::path& folder, std::size_t every = 1) {
  const testing::TemporaryFolder temporary;
  const auto log = temporary / "recording.rawlog";
  TumImportOptions import;
  import.folder = folder;
  import.log = log;
  import.gz_level = 1;
  const TumImportResult imported = importTum(import);
  const Trajectory truth = readTum(imported.ground_truth.value());

  const MotionOptions options;
  const auto tracker = std::make_shared<CameraTracker>(options);
  MountingEstimator mounting(options, tracker);
  MotionEstimator motion(options, tracker);
  RawlogSource source(log);
  std::vector<MotionIncrement> increments;
  std::vector<Pose2> estimate;
  std::vector<std::optional<Pose2>> expected;
  Result result;
  while (auto frame = source.next()) {
    if (frame->index % every != 0) continue;
    mounting.refine(*frame);
    increments.push_back(motion.increment(*frame, mounting.uncertainty()));
    const auto& increment = increments.back();
    estimate.push_back(estimate.empty() ? Pose2{} : estimate.back() * increment.T_previous_robot);
    expected.push_back(interpolated(truth, frame->stamp_s));
    result.failures += increment.source == MotionSource::kConstantVelocity;
    result.matched += expected.back().has_value();
    ++result.frames;
  }
  std::filesystem::remove(log);
  std::filesystem::remove(*imported.ground_truth);
  result.ate_rmse_m = alignedRmse(estimate, expected);

  constexpr std::size_t kSpan = 15;
  int spans = 0;
  for (std::size_t i = 0; i + kSpan < estimate.size(); ++i) {
    if (!expected[i] || !expected[i + kSpan]) continue;
    Pose2 T;
    // The truth errs too: 5 mm and 0.15 degrees between two frames.
    Eigen::Matrix3d P = Eigen::Vector3d(0.005, 0.005, radians(0.15)).cwiseAbs2().asDiagonal();
    for (std::size_t j = i + 1; j <= i + kSpan; ++j) {
      Eigen::Matrix3d J_start;
      Eigen::Matrix3d J_step;
      T = compose(T, increments[j].T_previous_robot, &J_start, &J_step);
      P = J_start * P * J_start.transpose() +
          J_step * increments[j].covariance * J_step.transpose();
    }
    Eigen::Vector3d e = T.vector() - (expected[i]->inverse() * *expected[i + kSpan]).vector();
    e.z() = wrapAngle(e.z());
    result.nees += e.dot(P.ldlt().solve(e)) / 3.0;
    ++spans;
  }
  result.nees /= spans;
  return result;
}

// Measured with one set of options: 0.02 m, 0.004 m and 0.04 m; NEES 1.4, 0.5 and 1.6.

TEST(Recording, CarriedThroughACorridorWithATurn) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  const Result result = track(folder);
  EXPECT_EQ(result.frames, 120);
  EXPECT_GE(result.matched, 110);
  EXPECT_EQ(result.failures, 0);
  EXPECT_LT(result.ate_rmse_m, 0.06);  // 10 m; frame-to-frame OpenCV: 0.18 m
  EXPECT_GT(result.nees, 0.1);
  EXPECT_LT(result.nees, 4.0);
}

TEST(Recording, BareWallsWithoutTexture) {
  COLONNADE_REQUIRE_RECORDING(folder, "tum_fr3_structure_notexture_far");
  const Result result = track(folder);
  EXPECT_GE(result.frames, 120);
  EXPECT_EQ(result.failures, 0);
  EXPECT_LT(result.ate_rmse_m, 0.03);
  EXPECT_GT(result.nees, 0.05);
  EXPECT_LT(result.nees, 4.0);
}

TEST(Recording, LargeStepsAroundACabinet) {
  COLONNADE_REQUIRE_RECORDING(folder, "tum_fr3_cabinet");
  const Result result = track(folder);
  EXPECT_GE(result.frames, 50);
  EXPECT_LE(result.failures, 2);
  EXPECT_LT(result.ate_rmse_m, 0.10);
  EXPECT_LT(result.nees, 5.0);
}

// 1.3 seconds and 13 degrees from frame to frame, and no wheels: 0.28 m from the former velocity
// and from standing still alone.
TEST(Recording, EvenLargerStepsAroundACabinet) {
  COLONNADE_REQUIRE_RECORDING(folder, "tum_fr3_cabinet");
  const Result result = track(folder, 2);
  EXPECT_GE(result.frames, 28);
  EXPECT_LE(result.failures, 1);
  EXPECT_LT(result.ate_rmse_m, 0.10);
}

}  // namespace
}  // namespace colonnade
