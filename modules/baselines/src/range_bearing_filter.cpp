// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_filter.hpp"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <cmath>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr float kFarthest_m = 20.0f;

mrpt::obs::CActionCollection::Ptr action(const Pose2& T_previous_robot,
                                         const Eigen::Matrix3d& covariance) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emOdometry;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(
      mrpt::poses::CPose2D(T_previous_robot.x, T_previous_robot.y, T_previous_robot.phi),
      mrpt::math::CMatrixDouble33(covariance));
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(movement);
  return actions;
}

mrpt::obs::CSensoryFrame::Ptr observation(const RangeBearingStep& step) {
  auto observation = mrpt::obs::CObservationBearingRange::Create();
  observation->maxSensorDistance = kFarthest_m;
  observation->fieldOfView_yaw = static_cast<float>(step.field_of_view);
  for (const Measurement& measurement : step.measurements) {
    const Eigen::Vector2d p = measurement.p_robot_camera;
    observation->sensorLocationOnRobot = mrpt::poses::CPose3D(p.x(), p.y(), 0.0, 0.0, 0.0, 0.0);
    mrpt::obs::CObservationBearingRange::TMeasurement reading{};
    reading.range = static_cast<float>(measurement.z(1));
    reading.yaw = static_cast<float>(measurement.z(0));
    reading.pitch = 0.0f;
    reading.landmarkID = -1;
    observation->sensedData.push_back(reading);
  }
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(observation);
  return frame;
}

}  // namespace

struct RangeBearingFilter::Impl {
  mrpt::slam::CRangeBearingKFSLAM2D filter;
  Pose2 T_world_start;  ///< the motion before the first landmark
  LandmarkMap book;     ///< what the filter does not remember of its landmarks
};

RangeBearingFilter::RangeBearingFilter(const KfSlamOptions& options)
    : impl_(std::make_unique<Impl>()) {
  auto& filter = impl_->filter;
  filter.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  filter.KF_options.method =
      options.update == "davison" ? mrpt::bayes::kfEKFAlaDavison : mrpt::bayes::kfEKFNaive;
  filter.options.data_assoc_method =
      options.association == "jcbb" ? mrpt::slam::assocJCBB : mrpt::slam::assocNN;
  filter.options.data_assoc_IC_chi2_thres = options.gate_probability;
}
RangeBearingFilter::~RangeBearingFilter() = default;

Pose2 RangeBearingFilter::step(const RangeBearingStep& step) {
  auto& [filter, T_world_start, book] = *impl_;
  if (book.empty()) T_world_start = T_world_start * step.T_previous_robot;
  if (!step.measurements.empty()) {
    double range_variance = 0.0;
    double bearing_variance = 0.0;
    for (const Measurement& measurement : step.measurements) {
      bearing_variance += measurement.R(0, 0);
      range_variance += measurement.R(1, 1);
    }
    const auto count = static_cast<double>(step.measurements.size());
    filter.options.std_sensor_range = static_cast<float>(std::sqrt(range_variance / count));
    filter.options.std_sensor_yaw = static_cast<float>(std::sqrt(bearing_variance / count));
  }
  auto actions = action(step.T_previous_robot, step.covariance);
  auto frame = observation(step);
  try {
    filter.processActionObservation(actions, frame);
  } catch (const std::exception& error) {
    const std::string text = error.what();
    throw Error("kf-slam: MRPT's filter gave up at " + formatFixed(step.stamp_s, 3) +
                " s: " + text.substr(0, text.find('\n')));
  }
  const auto& association = filter.getLastDataAssociation();
  for (const auto& [measurement, landmark] : association.newly_inserted_landmarks) {
    if (book.size() <= landmark) book.resize(landmark + 1);
    book[landmark].id = static_cast<LandmarkId>(landmark);
    book[landmark].kind = step.measurements[measurement].kind;
    book[landmark].observations = 1;
    book[landmark].first_stamp_s = book[landmark].last_stamp_s = step.stamp_s;
  }
  for (const auto& [measurement, landmark] : association.results.associations) {
    if (landmark >= book.size()) continue;
    ++book[landmark].observations;
    book[landmark].last_stamp_s = step.stamp_s;
  }
  mrpt::poses::CPosePDFGaussian robot;
  filter.getCurrentRobotPose(robot);
  return T_world_start * Pose2{robot.mean.x(), robot.mean.y(), robot.mean.phi()};
}

LandmarkMap RangeBearingFilter::landmarks() const {
  mrpt::poses::CPosePDFGaussian robot;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  impl_->filter.getCurrentState(robot, points, ids, state, covariance);
  LandmarkMap map = impl_->book;
  const Eigen::Matrix2d R = impl_->T_world_start.rotation();
  for (std::size_t i = 0; i < map.size() && i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 + 2 * i);
    map[i].p_world = transform(impl_->T_world_start, {points[i].x, points[i].y});
    map[i].extent_a = map[i].extent_b = map[i].p_world;
    map[i].covariance = R * covariance.asEigen().block<2, 2>(row, row) * R.transpose();
  }
  return map;
}

}  // namespace colonnade
