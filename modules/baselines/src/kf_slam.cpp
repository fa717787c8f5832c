// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "kf_slam.hpp"

#include <cmath>

#include "colonnade/detectors/edge_view_of.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "range_bearing_filter.hpp"

namespace colonnade {
namespace {

/// Twice the angle from the robot's heading to the farther side of the image.
double fieldOfView(const Frame& frame) {
  const Eigen::Vector3d axis = frame.T_robot_camera.linear().col(2);
  return 2.0 * (std::abs(std::atan2(axis.y(), axis.x())) +
                std::atan(0.5 * frame.camera.width_px / frame.camera.fx_px));
}

}  // namespace

struct KfSlam::Impl {
  explicit Impl(const BaselineOptions& options)
      : tracker(std::make_shared<CameraTracker>(options.motion)),
        mounting(options.motion, tracker),
        motion(options.motion, tracker),
        backend(makeEdgeLineBackend(kDefaultBackend, options.edges)),
        detectors(options.detectors),
        filter(options.kf) {}

  std::shared_ptr<CameraTracker> tracker;
  MountingEstimator mounting;
  MotionEstimator motion;
  std::unique_ptr<EdgeLineBackend> backend;
  DetectorBank detectors;
  RangeBearingFilter filter;
  std::size_t measurements = 0;
};

KfSlam::KfSlam(const BaselineOptions& options) : impl_(std::make_unique<Impl>(options)) {}
KfSlam::~KfSlam() = default;

BaselineStep KfSlam::step(const Frame& frame) {
  Frame refined = frame;
  impl_->mounting.refine(refined);
  const MotionIncrement motion = impl_->motion.increment(refined, impl_->mounting.uncertainty());
  const Detections detections =
      impl_->detectors.detect(refined, impl_->backend->extract(refined.gray, edgeViewOf(refined)));

  RangeBearingStep step;
  step.stamp_s = refined.stamp_s;
  step.T_previous_robot = motion.T_previous_robot;
  step.covariance = motion.covariance;
  step.field_of_view = refined.camera.isCalibrated() ? fieldOfView(refined) : 2.0 * kPi;
  for (const Detection& detection : detections)
    if (detection.accepted() && detection.kind() != LandmarkKind::kFloorEdge &&
        detection.measurement.hasRange())
      step.measurements.push_back(detection.measurement);
  impl_->measurements += step.measurements.size();

  const Pose2 T_world_robot = impl_->filter.step(step);
  return {T_world_robot,
          motion.source == MotionSource::kConstantVelocity ? "no motion measured" : "", 0.0};
}

LandmarkMap KfSlam::landmarks() const { return impl_->filter.landmarks(); }

std::map<std::string, double> KfSlam::figures() const {
  return {{"measurements", static_cast<double>(impl_->measurements)}};
}

}  // namespace colonnade
