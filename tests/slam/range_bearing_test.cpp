// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "colonnade/base/error.hpp"
#include "colonnade/slam/range_bearing_association.hpp"
#include "colonnade/slam/range_bearing_slam.hpp"

namespace colonnade {
namespace {

/// A robot on a circle among posts, with white noise; two rounds.
class PostHall {
 public:
  static constexpr double kRangeSigma_m = 0.05;
  static constexpr double kBearingSigma = radians(1.0);

  explicit PostHall(unsigned seed = 1) : random_(seed) {
    for (int i = 0; i < 12; ++i) {
      const double angle = 2.0 * kPi * i / 12.0;
      const double radius = i % 2 == 0 ? 5.0 : 2.0;
      posts_.emplace_back(radius * std::cos(angle), 3.0 + radius * std::sin(angle));
    }
  }

  struct Step {
    MotionIncrement motion;
    RangeBearingScan scan;
    Pose2 truth;
  };
  Step next() {
    const Pose2 way{0.15, 0.0, 0.05};
    truth_ = truth_ * way;
    Step step;
    step.truth = truth_;
    step.motion.T_previous_robot = {way.x + noise(0.01), way.y + noise(0.01),
                                    way.phi + noise(0.01)};
    step.motion.covariance.diagonal() << 1e-4, 1e-4, 1e-4;
    step.scan.range_sigma_m = kRangeSigma_m;
    step.scan.yaw_sigma = kBearingSigma;
    for (std::size_t i = 0; i < posts_.size(); ++i) {
      const Eigen::Vector2d p = transform(truth_.inverse(), posts_[i]);
      const double bearing = std::atan2(p.y(), p.x());
      if (p.norm() > 6.0 || std::abs(bearing) > 1.2) continue;
      step.scan.readings.push_back({static_cast<int>(i) + 1,
                                    p.norm() + noise(kRangeSigma_m),
                                    bearing + noise(kBearingSigma),
                                    0.0,
                                    {}});
    }
    return step;
  }
  double noise(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937_64 random_;
  std::vector<Eigen::Vector2d> posts_;
  Pose2 truth_;
};

/// Finite, symmetric to the bit, and positive semidefinite but for rounding.
void expectSound(const State& state) {
  ASSERT_TRUE(state.x.allFinite());
  ASSERT_TRUE(state.P.allFinite());
  EXPECT_EQ((state.P - state.P.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(state.P, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GE(eigenvalues.minCoeff(), -1e-9 * eigenvalues.maxCoeff());
}

constexpr int kSteps = 250;

struct Outcome {
  double rmse_m = 0.0;
  IdentityScore identities;
  std::size_t landmarks = 0;
};

/// Runs the hall, every scan changed by `spoil` before the filter sees it.
template <class Spoil>
Outcome drive(const RangeBearingOptions& options, Spoil spoil, unsigned seed = 1) {
  PostHall hall(seed);
  RangeBearingEstimator estimator(options, {});
  std::vector<int> identities;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    auto step = hall.next();
    spoil(hall, step.scan);
    for (const auto& reading : step.scan.readings) identities.push_back(reading.id);
    estimator.step(0.25 * i, step.motion, step.scan);
    // The world starts at the first pose.
    const Pose2 truth = Pose2{0.15, 0.0, 0.05}.inverse() * step.truth;
    const Pose2 error =
        truth.inverse() * (Pose2{0.15, 0.0, 0.05}.inverse() * estimator.filter().pose());
    sum += error.translation().squaredNorm();
  }
  expectSound(estimator.filter().state());
  return {std::sqrt(sum / kSteps), scoreIdentities(estimator.decisions(), identities),
          estimator.map().size()};
}

Outcome drive(const RangeBearingOptions& options) {
  return drive(options, [](PostHall&, RangeBearingScan&) {});
}

/// A robot that goes once and a quarter around a long ring of posts, 3 m apart in two rows.
struct RingOutcome {
  double rmse_m = 0.0;
  std::size_t landmarks = 0;
  double right_share = 0.0;
  std::size_t most_active = 0;
  State full;
};
/// Now and then there is something where `ghosts_m` says, ahead and to the left; never again.
RingOutcome driveRing(const RangeBearingOptions& options, int active_landmarks,
                      std::optional<Eigen::Vector2d> ghosts_m = std::nullopt) {
  constexpr double kRadius_m = 30.0;
  constexpr int kPosts = 120, kRingSteps = 790;
  std::mt19937_64 random(3);
  const auto noise = [&](double sigma) {
    return std::normal_distribution<double>(0.0, sigma)(random);
  };
  FilterOptions filter;
  filter.active_landmarks = active_landmarks;
  RangeBearingEstimator estimator(options, filter);
  RingOutcome outcome;
  std::vector<int> identities;
  Pose2 truth;
  for (int step = 0; step < kRingSteps; ++step) {
    const Pose2 way = step == 0 ? Pose2{} : Pose2{0.3, 0.0, 0.3 / kRadius_m};
    truth = truth * way;
    MotionIncrement motion;
    motion.T_previous_robot = {way.x + noise(0.01), way.y + noise(0.005), way.phi + noise(0.002)};
    motion.covariance.diagonal() << 1e-4, 2.5e-5, 4e-6;
    RangeBearingScan scan;
    scan.range_sigma_m = 0.05;
    scan.yaw_sigma = radians(0.5);
    for (int i = 0; i < kPosts; ++i) {
      const double angle = 2.0 * kPi * (i / 2) / (kPosts / 2);
      const double radius = kRadius_m + (i % 2 == 0 ? -2.0 : 2.0);
      const Eigen::Vector2d p = transform(
          truth.inverse(),
          Eigen::Vector2d(radius * std::sin(angle), kRadius_m - radius * std::cos(angle)));
      if (p.norm() > 6.0) continue;
      scan.readings.push_back(
          {i + 1, p.norm() + noise(0.05), std::atan2(p.y(), p.x()) + noise(radians(0.5)), 0.0, {}});
      identities.push_back(i + 1);
    }
    if (ghosts_m && step % 50 == 10) {
      scan.readings.push_back(
          {-1, ghosts_m->norm(), std::atan2(ghosts_m->y(), ghosts_m->x()), 0.0, {}});
      identities.push_back(-1);
    }
    estimator.step(0.25 * step, motion, scan);
    outcome.rmse_m +=
        (estimator.pose().translation() - truth.translation()).squaredNorm() / kRingSteps;
    outcome.most_active = std::max(outcome.most_active, estimator.filter().state().blocks.size());
  }
  outcome.rmse_m = std::sqrt(outcome.rmse_m);
  outcome.landmarks = estimator.map().size();
  outcome.right_share = scoreIdentities(estimator.decisions(), identities).rightShare();
  outcome.full = estimator.filter().fullState();
  return outcome;
}

TEST(RangeBearing, LargeMapsLetFarLandmarksRestAndLoseNothing) {
  RangeBearingOptions known, hidden;
  hidden.use_ids = false;
  hidden.association = "jcbb";
  for (RangeBearingOptions options : {known, hidden}) {
    options.world_with_map = false;
    const RingOutcome full = driveRing(options, 0);
    const RingOutcome compressed = driveRing(options, 12);
    EXPECT_LT(compressed.most_active, 45u);
    EXPECT_EQ(full.landmarks, compressed.landmarks);
    EXPECT_NEAR(full.rmse_m, compressed.rmse_m, 0.02 * full.rmse_m + 1e-3);
    EXPECT_NEAR(full.right_share, compressed.right_share, 0.01);
    ASSERT_EQ(full.full.x.size(), compressed.full.x.size());
    const Eigen::VectorXd sigma = full.full.P.diagonal().cwiseSqrt();
    EXPECT_LT(((full.full.x - compressed.full.x).cwiseQuotient(sigma)).cwiseAbs().maxCoeff(), 0.3);
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(compressed.full.P, Eigen::EigenvaluesOnly)
            .eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-9 * eigenvalues.maxCoeff());
  }
}

TEST(RangeBearing, WhatWasSeenOnceIsForgottenWhereItRests) {
  RangeBearingOptions options;
  options.use_ids = false;
  options.association = "jcbb";
  options.world_with_map = false;
  options.probation_s = 20.0;
  const RingOutcome full = driveRing(options, 0, Eigen::Vector2d(4.0, 12.0));
  const RingOutcome compressed = driveRing(options, 12, Eigen::Vector2d(4.0, 12.0));
  EXPECT_LT(full.landmarks, 123u);
  EXPECT_EQ(full.landmarks, compressed.landmarks);
}

TEST(RangeBearing, KnownIdentitiesMapAllPosts) {
  const Outcome outcome = drive({});
  EXPECT_EQ(outcome.landmarks, 12u);
  EXPECT_LT(outcome.rmse_m, 0.15);
  EXPECT_EQ(outcome.identities.rightShare(), 1.0);
}

TEST(RangeBearing, HiddenIdentitiesAreFoundByEveryMethod) {
  const double known = drive({}).rmse_m;
  for (const char* method : {"nn", "jcbb", "hypotheses"}) {
    RangeBearingOptions options;
    options.use_ids = false;
    options.association = method;
    options.birth_share = 0.001;
    const Outcome outcome = drive(options);
    // Histories side by side found a landmark twice now and then, and never merge the two.
    const bool beam = options.association == "hypotheses";
    EXPECT_GT(outcome.identities.rightShare(), beam ? 0.85 : 0.99) << method;
    EXPECT_NEAR(static_cast<double>(outcome.landmarks), 12.0, beam ? 3.0 : 1.0) << method;
    EXPECT_LT(outcome.rmse_m, 1.3 * known + 0.02) << method;
  }
}

TEST(RangeBearing, PartlyKnownIdentitiesJoinTheLandmarksFoundWithoutThem) {
  // Odd posts lose their identity always, all posts lose it in the first part of the drive.
  int scans = 0;
  RangeBearingOptions options;
  options.association = "jcbb";
  const Outcome outcome = drive(options, [&](PostHall&, RangeBearingScan& scan) {
    ++scans;
    for (auto& reading : scan.readings)
      if (reading.id % 2 == 1 || scans < 100) reading.id = -1;
  });
  EXPECT_NEAR(static_cast<double>(outcome.landmarks), 12.0, 1.0);
  EXPECT_LT(outcome.rmse_m, 0.2);
}

TEST(RangeBearing, BearingsAloneMapAllPostsAndNeedIdentities) {
  RangeBearingOptions options;
  options.bearing_only = true;
  const Outcome outcome = drive(options);
  EXPECT_EQ(outcome.landmarks, 12u);
  EXPECT_LT(outcome.rmse_m, 0.3);
  options.wait_for_parallax = true;
  const Outcome delayed = drive(options);
  EXPECT_EQ(delayed.landmarks, 12u);
  EXPECT_LT(delayed.rmse_m, 0.3);
  options.use_ids = false;
  EXPECT_THROW(RangeBearingEstimator(options, {}), Error);
}

TEST(RangeBearing, TheWorldMovesWithTheMapAndNothingWithinIt) {
  PostHall hall;
  RangeBearingEstimator estimator({}, {});
  double apart = 0.0, moved = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const auto step = hall.next();
    estimator.step(0.25 * i, step.motion, step.scan);
    const LandmarkMap here = estimator.map(), there = estimator.filter().landmarkMap();
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t k = 0; k < here.size(); ++k) {
      const auto seen = transform(estimator.pose().inverse(), here[k].p_world);
      const auto in_filter = transform(estimator.filter().pose().inverse(), there[k].p_world);
      apart = std::max(apart, (seen - in_filter).norm());
      moved = std::max(moved, (here[k].p_world - there[k].p_world).norm());
      EXPECT_NEAR(here[k].covariance.trace(), there[k].covariance.trace(), 1e-12);
    }
  }
  EXPECT_LT(apart, 1e-9);
  EXPECT_GT(moved, 1e-3);
}

TEST(RangeBearing, ThirtyPercentOutliersCostLittle) {
  for (const bool use_ids : {true, false}) {
    RangeBearingOptions options;
    options.use_ids = use_ids;
    double clean2 = 0.0, spoilt2 = 0.0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      // From a generator of their own: the other readings and the motion are those of the clean
      // run.
      std::mt19937_64 random(100 + seed);
      const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
      };
      const auto outliers = [&](PostHall&, RangeBearingScan& scan) {
        for (auto& reading : scan.readings)
          if (uniform(0.0, 1.0) < 0.3) {
            reading.range_m = uniform(0.2, 6.0);
            reading.yaw = uniform(-1.2, 1.2);
          }
      };
      const double clean = drive(
                               options, [](PostHall&, RangeBearingScan&) {}, seed)
                               .rmse_m;
      const double spoilt = drive(options, outliers, seed).rmse_m;
      EXPECT_LT(spoilt, 2.0 * clean) << (use_ids ? "known" : "hidden") << ", seed " << seed;
      clean2 += clean * clean;
      spoilt2 += spoilt * spoilt;
    }
    EXPECT_LT(std::sqrt(spoilt2), 1.5 * std::sqrt(clean2)) << (use_ids ? "known" : "hidden");
  }
}

TEST(RangeBearing, RefusedReadingsChangeNoBit) {
  PostHall hall;
  RangeBearingEstimator estimator({}, {});
  for (int i = 0; i < 60; ++i) {
    const auto step = hall.next();
    estimator.step(0.25 * i, step.motion, step.scan);
  }
  const Eigen::VectorXd x = estimator.filter().state().x;
  const Eigen::MatrixXd P = estimator.filter().state().P;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  RangeBearingScan scan;
  scan.range_sigma_m = 0.05;
  scan.yaw_sigma = 0.02;
  for (const double range : {nan, infinite, -1.0, 0.0, 1e30})
    scan.readings.push_back({1, range, 0.1, 0.0, {}});
  scan.readings.push_back({2, 3.0, nan, 0.0, {}});
  scan.readings.push_back({3, 3.0, 0.1, infinite, {}});
  MotionIncrement still;
  estimator.step(100.0, still, scan);
  EXPECT_EQ(estimator.filter().state().x, x);
  EXPECT_EQ(estimator.filter().state().P, P);
  EXPECT_EQ(estimator.filter().health().refused().at("reading not finite or out of range"), 7u);
}

TEST(RangeBearing, AWrongFirstReadingIsForgotten) {
  int scans = 0;
  const Outcome outcome = drive({}, [&](PostHall&, RangeBearingScan& scan) {
    if (scans++ == 0)
      for (auto& reading : scan.readings)
        if (reading.id == 1) reading.yaw += 0.7;
  });
  EXPECT_EQ(outcome.landmarks, 12u);
  EXPECT_LT(outcome.rmse_m, 0.2);
}

TEST(RangeBearing, JointCompatibilityRefusesPairsThatFitOneByOne) {
  FilterOptions plain;
  plain.gate_probability = 0.99;
  EkfSlam filter(plain);
  Measurement m;
  m.z.resize(2);
  m.R = Eigen::Matrix2d::Identity() * 1e-4;
  std::vector<LandmarkId> ids;
  for (const double bearing : {-0.3, 0.3}) {
    m.z << bearing, 4.0;
    ids.push_back(filter.addLandmark(m).value());
  }
  // The heading is in doubt: both may lie off by 0.1 rad, but only in the same direction.
  filter.predict({}, Eigen::Vector3d(1e-6, 1e-6, 4e-3).asDiagonal());
  std::vector<OpenReading> readings(2, {m, ids});
  readings[0].measurement.z << -0.3 + 0.1, 4.0;
  readings[1].measurement.z << 0.3 + 0.1, 4.0;
  EXPECT_EQ(associateOpen(readings, filter, {}).landmark[0], ids[0]);
  EXPECT_EQ(associateOpen(readings, filter, {}).landmark[1], ids[1]);
  readings[1].measurement.z << 0.3 - 0.1, 4.0;
  const auto apart = associateOpen(readings, filter, {});
  EXPECT_EQ(apart.landmark[0].has_value() + apart.landmark[1].has_value(), 1);
  OpenAssociationOptions nearest;
  nearest.joint = false;
  const auto one_by_one = associateOpen(readings, filter, nearest);
  EXPECT_TRUE(one_by_one.landmark[0] && one_by_one.landmark[1]);
}

TEST(RangeBearing, BearingsAreComparedAcrossTheBackOfTheRobot) {
  EkfSlam filter({});
  Measurement m;
  m.z.resize(2);
  m.z << kPi - 0.005, 4.0;
  m.R = Eigen::Matrix2d::Identity() * 1e-4;
  const LandmarkId id = filter.addLandmark(m).value();
  m.z << -kPi + 0.005, 4.0;
  const std::vector<OpenReading> readings{{m, {id}}};
  EXPECT_EQ(associateOpen(readings, filter, {}).landmark[0], id);
}

/// Hidden identities, and twelve that stand on all of them.
TEST(RangeBearing, TenThousandReadingsInOneFrameLeaveTheFilterSound) {
  for (const bool use_ids : {false, true}) {
    RangeBearingOptions options;
    options.use_ids = use_ids;
    RangeBearingEstimator estimator(options, {});
    PostHall hall;
    for (int i = 0; i < 40; ++i) {
      const auto step = hall.next();
      estimator.step(0.25 * i, step.motion, step.scan);
    }
    RangeBearingScan scan;
    for (int i = 0; i < 10000; ++i)
      scan.readings.push_back(
          {1 + i % 12, hall.uniform(0.2, 6.0), hall.uniform(-1.2, 1.2), 0.0, {}});
    scan.range_sigma_m = 0.05;
    scan.yaw_sigma = 0.02;
    const auto report = estimator.step(20.0, {}, scan);
    EXPECT_EQ(report.landmarks.size(), 10000u);
    expectSound(estimator.filter().fullState());
  }
}

TEST(RangeBearing, ReadsTheKeysOfKfSlam) {
  mrpt::config::CConfigFileMemory ini(
      std::string("[RangeBearingKFSLAM]\nstd_sensor_range = 0.03\nstd_sensor_yaw_deg = 0.1\n"
                  "data_assoc_method = assocJCBB\ndata_assoc_IC_chi2_thres = 0.95\n"
                  "stds_Q_no_odo = [0.2 0.3 5]\n"));
  RangeBearingSlam slam;
  slam.loadOptions(ini);
  EXPECT_DOUBLE_EQ(slam.options.std_sensor_range, 0.03);
  EXPECT_NEAR(slam.options.std_sensor_yaw, radians(0.1), 1e-12);
  EXPECT_EQ(slam.options.data_assoc_method, RangeBearingSlam::assocJCBB);
  EXPECT_DOUBLE_EQ(slam.options.data_assoc_IC_chi2_thres, 0.95);
  EXPECT_NEAR(slam.options.stds_Q_no_odo[2], radians(5.0), 1e-12);
  ini.write("RangeBearingKFSLAM", "data_assoc_method", "assocMagic");
  EXPECT_THROW(slam.loadOptions(ini), Error);
}

}  // namespace
}  // namespace colonnade
