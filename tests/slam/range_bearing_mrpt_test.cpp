// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>
#include <mrpt/system/COutputLogger.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>

#include "colonnade/base/text.hpp"
#include "colonnade/slam/range_bearing_slam.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using mrpt::slam::CRangeBearingKFSLAM2D;

// The sigmas of EKF-SLAM_test_2d.ini, which MRPT ships for this log.
constexpr double kRangeSigma_m = 0.03;
constexpr double kBearingSigma = radians(0.1);

void prepare(CRangeBearingKFSLAM2D& mrpt) {
  mrpt.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  mrpt.KF_options.verbosity_level = mrpt::system::LVL_ERROR;
  mrpt.KF_options.method = mrpt::bayes::kfEKFNaive;
  mrpt.options.std_sensor_range = static_cast<float>(kRangeSigma_m);
  mrpt.options.std_sensor_yaw = static_cast<float>(kBearingSigma);
}

/// MRPT keeps its sigmas in single precision.
void prepare(RangeBearingSlam& slam, bool invariant) {
  slam.options.std_sensor_range = static_cast<double>(static_cast<float>(kRangeSigma_m));
  slam.options.std_sensor_yaw = static_cast<double>(static_cast<float>(kBearingSigma));
  slam.options.filter.invariant = invariant;
  slam.options.extra.wait_for_landmark = true;
  slam.options.extra.known_gate_probability = 1.0;
  slam.options.data_assoc_IC_chi2_thres = 1.0;
  slam.reset();
}

/// Calls `use(action, frame)` for every pair of a log, as kf-slam reads it.
template <class Use>
void forEachPair(const std::filesystem::path& log, Use use) {
  mrpt::io::CFileGZInputStream file(log.string());
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr loose;
  std::size_t entry = 0;
  while (mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, action, frame, loose,
                                                                   entry))
    use(action, frame);
}

struct LandmarkError {
  double mean_m = 0.0;
  double max_m = 0.0;
};

/// Against `x y z . . . id` lines; no alignment: both start at the origin.
LandmarkError errorOf(const std::vector<mrpt::math::TPoint2D>& landmarks,
                      const std::map<unsigned int, std::int64_t>& identities,
                      const std::filesystem::path& truth_file) {
  std::map<std::int64_t, Eigen::Vector2d> truth;
  std::ifstream file(truth_file);
  for (std::string line; std::getline(file, line);) {
    const auto entries = words(line);
    if (entries.size() == 7)
      truth[static_cast<std::int64_t>(parseDouble(entries[6]).value())] = {
          parseDouble(entries[0]).value(), parseDouble(entries[1]).value()};
  }
  LandmarkError error;
  for (const auto& [place, identity] : identities) {
    const Eigen::Vector2d p(landmarks[place].x, landmarks[place].y);
    const double distance = (p - truth.at(identity)).norm();
    error.mean_m += distance / static_cast<double>(identities.size());
    error.max_m = std::max(error.max_m, distance);
  }
  return error;
}

template <class Filter>
LandmarkError errorOf(const Filter& filter, const std::filesystem::path& truth_file) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::map<unsigned int, std::int64_t> identities;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  filter.getCurrentState(pose, landmarks, identities, state, covariance);
  EXPECT_EQ(identities.size(), 70u);
  return errorOf(landmarks, identities, truth_file);
}

TEST(RangeBearingAgainstMrpt, PlainFilterFollowsKfSlamPoseByPose) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/kf-slam_demo.rawlog");
  CRangeBearingKFSLAM2D mrpt;
  prepare(mrpt);
  RangeBearingSlam slam;
  prepare(slam, false);
  double worst = 0.0, worst_covariance = 0.0;
  std::size_t steps = 0;
  forEachPair(log, [&](auto& action, auto& frame) {
    mrpt.processActionObservation(action, frame);
    slam.processActionObservation(action, frame);
    mrpt::poses::CPosePDFGaussian theirs, ours;
    mrpt.getCurrentRobotPose(theirs);
    slam.getCurrentRobotPose(ours);
    worst = std::max({worst, std::abs(theirs.mean.x() - ours.mean.x()),
                      std::abs(theirs.mean.y() - ours.mean.y()),
                      std::abs(wrapAngle(theirs.mean.phi() - ours.mean.phi()))});
    worst_covariance =
        std::max(worst_covariance, (theirs.cov - ours.cov).asEigen().cwiseAbs().maxCoeff());
    ++steps;
  });
  RecordProperty("worst", std::to_string(worst));
  std::printf("largest difference of a pose over %zu steps: %.1e, of its covariance: %.1e\n", steps,
              worst, worst_covariance);
  EXPECT_GE(steps, 249u);
  EXPECT_LT(worst, 1e-8);
  EXPECT_LT(worst_covariance, 1e-9);
}

TEST(RangeBearingAgainstMrpt, InvariantFilterMapsAsWell) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/kf-slam_demo.rawlog");
  COLONNADE_REQUIRE_RECORDING(truth, "mrpt/kf-slam_demo_ground_truth.txt");
  CRangeBearingKFSLAM2D mrpt;
  prepare(mrpt);
  RangeBearingSlam slam;
  prepare(slam, true);
  forEachPair(log, [&](auto& action, auto& frame) {
    mrpt.processActionObservation(action, frame);
    slam.processActionObservation(action, frame);
  });
  const LandmarkError theirs = errorOf(mrpt, truth);
  const LandmarkError ours = errorOf(slam, truth);
  std::printf("landmark error, mean and largest: MRPT %.5f %.5f m, here %.5f %.5f m\n",
              theirs.mean_m, theirs.max_m, ours.mean_m, ours.max_m);
  EXPECT_NEAR(theirs.mean_m, 0.00368, 1e-5);  // as kf-slam prints it
  EXPECT_LT(ours.mean_m, 1.05 * 0.00368);
  EXPECT_LT(ours.max_m, 1.05 * 0.01250);
}

/// A sensor that is right, but not known to be, shares the errors of the wheels; and the filter
/// takes its derivatives where it expects the readings, which motions as unsure as these make worth
/// 3 %.
TEST(RangeBearingAgainstMrpt, EstimatingARightSensorCosts) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/kf-slam_demo.rawlog");
  COLONNADE_REQUIRE_RECORDING(truth, "mrpt/kf-slam_demo_ground_truth.txt");
  RangeBearingSlam slam;
  prepare(slam, true);
  slam.options.extra.estimate_sensor = true;
  slam.reset();
  forEachPair(log,
              [&](auto& action, auto& frame) { slam.processActionObservation(action, frame); });
  const LandmarkError error = errorOf(slam, truth);
  const SensorEstimate sensor = *slam.estimator().filter().sensor();
  std::printf("landmark error, mean and largest: %.5f %.5f m; ranges %.4f +- %.4f long\n",
              error.mean_m, error.max_m, sensor.errors.range_scale,
              std::sqrt(sensor.covariance(1, 1)));
  EXPECT_LT(error.mean_m, 0.3);
  EXPECT_LT(std::abs(sensor.errors.range_scale), 0.05);
}

TEST(RangeBearingAgainstMrpt, HiddenIdentitiesAreFoundAgain) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/kf-slam_demo.rawlog");
  for (const auto method : {RangeBearingSlam::assocNN, RangeBearingSlam::assocJCBB}) {
    RangeBearingSlam slam;
    prepare(slam, true);
    slam.options.data_assoc_method = method;
    slam.options.data_assoc_IC_chi2_thres = 0.999;
    slam.options.extra.joint_probability = 0.999;
    slam.options.extra.use_ids = false;
    slam.reset();
    std::vector<int> identities;
    forEachPair(log, [&](auto& action, auto& frame) {
      for (const auto& reading :
           frame->template getObservationByClass<mrpt::obs::CObservationBearingRange>()->sensedData)
        identities.push_back(reading.landmarkID);
      slam.processActionObservation(action, frame);
    });
    const IdentityScore score = scoreIdentities(slam.estimator().decisions(), identities);
    std::printf("%s: %zu of %zu readings associated, %.4f of them right, %zu landmarks\n",
                method == RangeBearingSlam::assocNN ? "nn" : "jcbb", score.associated,
                score.readings, score.rightShare(), slam.estimator().map().size());
    EXPECT_GT(score.rightShare(), method == RangeBearingSlam::assocNN ? 0.95 : 0.99);
    EXPECT_GT(static_cast<double>(score.associated), 0.95 * static_cast<double>(score.readings));
  }
}

TEST(RangeBearingAgainstMrpt, DrawsRobotAndLandmarks) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/kf-slam_demo.rawlog");
  RangeBearingSlam slam;
  prepare(slam, true);
  forEachPair(log,
              [&](auto& action, auto& frame) { slam.processActionObservation(action, frame); });
  mrpt::opengl::CSetOfObjects::Ptr scene;
  slam.getAs3DObject(scene);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->size(), 71u);
  const auto ellipse =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(scene->getByName("landmark 7"));
  ASSERT_TRUE(ellipse);
  // Three sigmas to either side, as the covariance of that landmark has them along x.
  double farthest_m = 0.0;
  for (std::size_t i = 0; i < ellipse->size(); ++i) {
    double x, y, z, to_x, to_y, to_z;
    ellipse->getLineByIndex(i, x, y, z, to_x, to_y, to_z);
    farthest_m = std::max(farthest_m, to_x);
  }
  const auto map = slam.estimator().map();
  const auto landmark = std::find_if(map.begin(), map.end(), [&](const LandmarkRecord& record) {
    return slam.estimator().identityOf(record.id) == 7;
  });
  ASSERT_NE(landmark, map.end());
  EXPECT_NEAR(farthest_m, 3.0 * std::sqrt(landmark->covariance(0, 0)), 0.02 * farthest_m);
}

}  // namespace
}  // namespace colonnade
