// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/motion/camera_tracker.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "opencv_odometry.hpp"
#include "rgbd_alignment.hpp"
#include "rgbd_pyramid.hpp"
#include "se3.hpp"

namespace colonnade {
namespace {

constexpr int kLevels = 4;
constexpr double kLongestCoast_s = 1.0;

Eigen::Isometry3d scaledMotion(const Eigen::Isometry3d& T, double factor) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const Eigen::AngleAxisd turn(T.linear());
  out.linear() = Eigen::AngleAxisd(factor * turn.angle(), turn.axis()).toRotationMatrix();
  out.translation() = factor * T.translation();
  return out;
}

}  // namespace

struct CameraTracker::Impl {
  explicit Impl(const MotionOptions& motion_options) : options(motion_options) {
    alignment_options.use_photometric = options.use_photometric;
    alignment_options.use_surfaces = options.use_surfaces;
    alignment_options.photometric_correlation = options.photometric_correlation;
    alignment_options.surface_correlation = options.surface_correlation;
    alignment_options.weak_direction_ratio = options.weak_direction_ratio;
  }

  MotionOptions options;
  AlignmentOptions alignment_options;

  std::optional<std::size_t> last_index;
  double last_stamp_s = 0.0;
  std::optional<Reference> key;
  RgbdPyramid previous;  ///< the former frame, to become the next key frame
  bool previous_is_key = false;
  Eigen::Isometry3d T_key_previous = Eigen::Isometry3d::Identity();
  Matrix6 covariance_key_previous = Matrix6::Zero();
  Eigen::Isometry3d velocity = Eigen::Isometry3d::Identity();  ///< motion in velocity_dt_s
  double velocity_dt_s = 0.0;
  double coasted_s = 0.0;
  CameraMotion motion;

  bool isPlausible(const Eigen::Isometry3d& T_previous_camera, double dt_s) const {
    const double time_s = std::max(dt_s, 0.02) + coasted_s;
    return T_previous_camera.translation().norm() < options.max_speed_m_s * time_s + 0.05 &&
           Eigen::AngleAxisd(T_previous_camera.linear()).angle() <
               options.max_turn_rate * time_s + radians(2.0);
  }

  bool isSound(const Alignment& alignment) const {
    return alignment.converged && alignment.photometric_share + alignment.surface_share > 0 &&
           std::max(alignment.photometric_share, alignment.surface_share) >= options.min_share;
  }

  Eigen::Isometry3d predicted(double dt_s) const {
    if (velocity_dt_s <= 0.0) return Eigen::Isometry3d::Identity();
    return scaledMotion(velocity, std::clamp(dt_s / velocity_dt_s, 0.0, 5.0));
  }

  MotionSource sourceOf(const Alignment& alignment) const {
    if (alignment.photometric_count < 50) return MotionSource::kIcp;
    if (alignment.surface_count < 50) return MotionSource::kPhotometric;
    return MotionSource::kPhotometricIcp;
  }

  void makePreviousTheKey() {
    key = makeReference(previous);
    T_key_previous = Eigen::Isometry3d::Identity();
    covariance_key_previous.setZero();
  }

  Alignment estimate(const RgbdPyramid& current,
                     const std::vector<Eigen::Isometry3d>& guesses) const {
    if (options.engine == "direct") return align(*key, current, guesses, alignment_options);
    const auto T = openCvOdometry(options.engine, previous, current,
                                  T_key_previous.inverse() * guesses.front());
    if (!T) return {};
    return evaluateAt(*key, current, T_key_previous * *T, alignment_options);
  }

  /// What no residual tells: shutter, unsynchronised images, calibration. Grows with the motion.
  Matrix6 modelError(const Eigen::Isometry3d& T_previous_camera) const {
    const double way = options.model_error * T_previous_camera.translation().norm();
    const double turn = options.model_error * Eigen::AngleAxisd(T_previous_camera.linear()).angle();
    Matrix6 covariance = Matrix6::Zero();
    covariance.diagonal().head<3>().setConstant(way * way + 1e-8);
    covariance.diagonal().tail<3>().setConstant(turn * turn + 1e-8);
    return covariance;
  }

  bool keyIsWornOut(const Alignment& alignment) const {
    const auto& T = alignment.T_reference_current;
    return T.translation().norm() > options.keyframe_distance_m ||
           Eigen::AngleAxisd(T.linear()).angle() > options.keyframe_angle ||
           std::min(alignment.photometric_share, alignment.surface_share) < options.keyframe_share;
  }

  /// Aligns to the key frame, or, when that fails, to the former frame made the key frame.
  bool alignTo(const RgbdPyramid& current, double dt_s) {
    if (current.levels.empty() || previous.levels.empty()) return false;
    if (!key) makePreviousTheKey();
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::vector<Eigen::Isometry3d> guesses = {T_key_previous * predicted(dt_s),
                                                      T_key_previous};
      const Alignment alignment = estimate(current, guesses);
      const Eigen::Isometry3d T_previous_camera =
          T_key_previous.inverse() * alignment.T_reference_current;
      if (isSound(alignment) && isPlausible(T_previous_camera, dt_s)) {
        const Matrix6 Ad = adjoint(T_previous_camera.inverse());
        motion.T_previous_camera = T_previous_camera;
        motion.covariance = alignment.covariance + Ad * covariance_key_previous * Ad.transpose() +
                            modelError(T_previous_camera);
        motion.source = sourceOf(alignment);
        T_key_previous = alignment.T_reference_current;
        covariance_key_previous = alignment.covariance;
        if (keyIsWornOut(alignment)) key.reset();
        return true;
      }
      if (attempt == 0) makePreviousTheKey();
    }
    key.reset();
    return false;
  }

  void coast(double dt_s) {
    coasted_s += dt_s;
    if (coasted_s > kLongestCoast_s) velocity = Eigen::Isometry3d::Identity();
    motion.T_previous_camera = predicted(dt_s);
    const double speed = options.coasting_speed_sigma_m_s * dt_s;
    const double turn = options.coasting_turn_sigma * dt_s;
    // The unknown change of velocity lasts: errors of consecutive frames add up, not their squares.
    const double lasting = dt_s > 0.0 ? std::max(1.0, coasted_s / dt_s) : 1.0;
    motion.covariance.setZero();
    motion.covariance.diagonal().head<3>().setConstant(speed * speed * lasting + 1e-6);
    motion.covariance.diagonal().tail<3>().setConstant(turn * turn * lasting + 1e-6);
    motion.source = MotionSource::kConstantVelocity;
  }
};

CameraTracker::CameraTracker(const MotionOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
CameraTracker::~CameraTracker() = default;
CameraTracker::CameraTracker(CameraTracker&&) noexcept = default;
CameraTracker& CameraTracker::operator=(CameraTracker&&) noexcept = default;

const CameraMotion& CameraTracker::track(const Frame& frame) {
  Impl& self = *impl_;
  if (self.last_index == frame.index) return self.motion;
  const bool is_first = !self.last_index;
  const double dt_s = is_first ? 0.0 : std::max(0.0, frame.stamp_s - self.last_stamp_s);
  self.last_index = frame.index;
  self.last_stamp_s = frame.stamp_s;
  self.motion = CameraMotion{};
  RgbdPyramid current = makePyramid(frame, kLevels);
  if (!is_first) {
    if (self.alignTo(current, dt_s)) {
      self.velocity = self.motion.T_previous_camera;
      self.velocity_dt_s = dt_s;
      self.coasted_s = 0.0;
    } else {
      self.coast(dt_s);
    }
  }
  self.previous = std::move(current);
  return self.motion;
}

}  // namespace colonnade
