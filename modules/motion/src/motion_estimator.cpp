// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/motion/motion_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "floor_tracker.hpp"
#include "fusion.hpp"
#include "planar_reduction.hpp"
#include "wheel_calibration.hpp"
#include "wheel_odometry.hpp"

namespace colonnade {

const char* name(MotionSource source) {
  switch (source) {
    case MotionSource::kNone:
      return "none";
    case MotionSource::kOdometry:
      return "odometry";
    case MotionSource::kOdometryVisual:
      return "odometry_visual";
    case MotionSource::kPhotometric:
      return "photometric";
    case MotionSource::kPhotometricIcp:
      return "photometric_icp";
    case MotionSource::kIcp:
      return "icp";
    case MotionSource::kFloor:
      return "floor";
    case MotionSource::kConstantVelocity:
      return "constant_velocity";
  }
  return "unknown";
}

struct MotionEstimator::Impl {
  Impl(const MotionOptions& motion_options, std::shared_ptr<CameraTracker> camera_tracker)
      : options(motion_options),
        tracker(std::move(camera_tracker)),
        floor(motion_options),
        calibration(motion_options) {}

  MotionOptions options;
  std::shared_ptr<CameraTracker> tracker;
  FloorTracker floor;
  WheelCalibration calibration;
  std::optional<std::size_t> previous_index;
  double previous_stamp_s = 0.0;
  std::optional<OdometryReading> previous_odometry;
  Eigen::Isometry3d T_robot_camera_previous = Eigen::Isometry3d::Identity();
  Pose2 previous_increment;  ///< for constant velocity
  double previous_dt_s = 0.0;
  double coasted_s = 0.0;

  bool mayUseOdometry() const { return options.source == "auto" || options.source == "odometry"; }
  bool mayUseVisual() const { return options.source == "auto" || options.source == "visual"; }

  /// The motion of a step of dt_s at the former velocity.
  Pose2 formerVelocity(double dt_s) const {
    if (previous_dt_s <= 0.0) return {};
    const double factor = std::clamp(dt_s / previous_dt_s, 0.0, 5.0);
    return {factor * previous_increment.x, factor * previous_increment.y,
            factor * previous_increment.phi};
  }

  /// The former velocity in the plane, for frames that nothing else measures.
  MotionIncrement coast(double dt_s) {
    MotionIncrement increment;
    increment.source = MotionSource::kConstantVelocity;
    coasted_s += dt_s;
    if (coasted_s < 1.0) increment.T_previous_robot = formerVelocity(dt_s);
    // The unknown change of velocity lasts: errors of consecutive frames add up, not their squares.
    const double lasting = dt_s > 0.0 ? std::clamp(coasted_s / dt_s, 1.0, 3.0) : 1.0;
    const double step = lasting * options.coasting_speed_sigma_m_s * dt_s + 1e-3;
    const double turn = lasting * options.coasting_turn_sigma * dt_s + 1e-3;
    increment.covariance.diagonal() << step * step, step * step, turn * turn;
    return increment;
  }

  std::optional<MotionIncrement> byWheels(const Frame& frame) const {
    if (!mayUseOdometry() || !previous_odometry || !frame.odometry) return std::nullopt;
    return odometryIncrement(*previous_odometry, *frame.odometry, options);
  }

  std::optional<MotionIncrement> byCamera(const Frame& frame, const MountingAtFrame& mounting) {
    if (!mayUseVisual() || frame.depth_m.empty()) return std::nullopt;
    const CameraMotion& motion = tracker->track(frame);
    if (!motion.previous_index || motion.previous_index != previous_index) return std::nullopt;
    return reduceToPlane(motion, T_robot_camera_previous, mounting);
  }

  /// Without depth: the floor's texture. The guess is the wheels' motion, else the former velocity.
  std::optional<MotionIncrement> byFloor(const Frame& frame,
                                         const std::optional<MotionIncrement>& wheels,
                                         double dt_s) {
    if (!mayUseVisual() || !options.use_floor || !frame.depth_m.empty()) return std::nullopt;
    MotionIncrement guess;
    guess.source = MotionSource::kConstantVelocity;
    guess.T_previous_robot = formerVelocity(dt_s);
    return floor.track(frame, wheels.value_or(guess));
  }

  /// Direct alignment is local: after a longer step it may rest in a wrong minimum and be sure of
  /// it.
  bool isWithinReach(const MotionIncrement& wheels) const {
    return wheels.T_previous_robot.translation().norm() <= options.visual_reach_m &&
           std::abs(wheels.T_previous_robot.phi) <= options.visual_reach_angle;
  }

  /// A turn brings floor and walls into view that no former frame has told apart.
  bool isSharpTurn(const MotionIncrement& motion) const {
    constexpr double kStill = radians(0.3);
    return std::abs(motion.T_previous_robot.phi) >
           kStill + options.floor_turn_per_m * motion.T_previous_robot.translation().norm();
  }

  bool contradictsWheels(const Frame& frame, const MotionIncrement& camera) const {
    return camera.source != MotionSource::kFloor && tracker->track(frame).contradicts_wheels;
  }

  /// What surfaces do not tell rests on wheels that brightness contradicts.
  static MotionIncrement fuseDoubted(MotionIncrement wheels, const MotionIncrement& camera) {
    doubt(wheels);
    const MotionIncrement fused = fuse(wheels, camera);
    return fused.source == MotionSource::kOdometry ? wheels : fused;
  }

  MotionIncrement measure(const Frame& frame, const MountingAtFrame& mounting, double dt_s) {
    const auto read = byWheels(frame);
    auto wheels = read;
    if (wheels) wheels = calibration.corrected(*wheels);
    auto camera = byCamera(frame, mounting);
    if (!frame.depth_m.empty()) floor.reset();
    if (!camera) camera = byFloor(frame, read, dt_s);
    if (wheels && frame.depth_m.empty() && floor.contradictsWheels()) doubt(*wheels);
    if (camera && wheels && camera->source == MotionSource::kFloor && isSharpTurn(*wheels))
      camera.reset();
    if (wheels && camera && camera->source != MotionSource::kConstantVelocity &&
        isWithinReach(*wheels)) {
      if (contradictsWheels(frame, *camera)) return fuseDoubted(*wheels, *camera);
      calibration.learn(*read, *camera);
      return fuse(*wheels, *camera);
    }
    if (wheels) return *wheels;
    return camera ? *camera : coast(dt_s);
  }
};

MotionEstimator::MotionEstimator(const MotionOptions& options,
                                 std::shared_ptr<CameraTracker> tracker)
    : impl_(std::make_unique<Impl>(options, std::move(tracker))) {}
MotionEstimator::~MotionEstimator() = default;

MotionIncrement MotionEstimator::increment(const Frame& frame,
                                           const MountingUncertainty& uncertainty) {
  Impl& self = *impl_;
  const MountingAtFrame mounting{frame.T_robot_camera, uncertainty.step_covariance};
  MotionIncrement result;
  if (self.previous_index) {
    const double dt_s = std::max(0.0, frame.stamp_s - self.previous_stamp_s);
    result = self.measure(frame, mounting, dt_s);
    if (result.source != MotionSource::kConstantVelocity) {
      self.coasted_s = 0.0;
      self.previous_increment = result.T_previous_robot;
      self.previous_dt_s = dt_s;
    }
  } else {
    if (self.mayUseVisual() && !frame.depth_m.empty()) self.tracker->track(frame);
    self.byFloor(frame, std::nullopt, 0.0);
  }
  self.previous_index = frame.index;
  self.previous_stamp_s = frame.stamp_s;
  self.previous_odometry = frame.odometry;
  self.T_robot_camera_previous = frame.T_robot_camera;
  return result;
}

}  // namespace colonnade
