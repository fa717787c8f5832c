// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/motion/camera_tracker.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "alignment_checks.hpp"
#include "camera_by_wheels.hpp"
#include "former_velocity.hpp"
#include "lens_falloff.hpp"
#include "mirrored_cells.hpp"
#include "opencv_odometry.hpp"
#include "rgbd_alignment.hpp"
#include "rgbd_pyramid.hpp"
#include "se3.hpp"
#include "standing_part.hpp"
#include "turned_starts.hpp"

namespace colonnade {
namespace {

constexpr int kLevels = 4;
constexpr double kLongestCoast_s = 1.0;
constexpr double kPriorSigmas = 6.0;      ///< times the wheels', so that they hardly count twice
constexpr double kContradiction = 12.59;  ///< 5 %: what it costs is little

}  // namespace

struct CameraTracker::Impl {
  explicit Impl(const MotionOptions& motion_options) : options(motion_options) {
    alignment_options.use_photometric = options.use_photometric;
    alignment_options.use_surfaces = options.use_surfaces;
    alignment_options.photometric_correlation = options.photometric_correlation;
    alignment_options.surface_correlation = options.surface_correlation;
    alignment_options.min_share = options.min_share;
    alignment_options.weak_direction_ratio = options.weak_direction_ratio;
  }

  MotionOptions options;
  AlignmentOptions alignment_options;

  std::optional<std::size_t> last_index;
  double last_stamp_s = 0.0;
  std::optional<Reference> key;
  RgbdPyramid previous;  ///< the former frame, to become the next key frame
  Eigen::Isometry3d T_key_previous = Eigen::Isometry3d::Identity();
  Matrix6 covariance_key_previous = Matrix6::Zero();
  FormerVelocity velocity;
  LensFalloff falloff;
  double coasted_s = 0.0;
  PolishedFloor polish;
  std::optional<MirroredCells> cells;  ///< of the alignment at hand
  /// Of the former frame.
  std::optional<OdometryReading> odometry_previous;
  Eigen::Isometry3d T_robot_camera_previous = Eigen::Isometry3d::Identity();
  std::optional<CameraByWheels> by_wheels;  ///< since the former frame
  CameraMotion motion;

  double timeSinceTracked(double dt_s) const { return std::max(dt_s, 0.02) + coasted_s; }

  /// Nothing from an odometry that jumps.
  std::optional<CameraByWheels> byWheels(const Frame& frame, double dt_s) const {
    if (options.source != "auto" || !odometry_previous || !frame.odometry) return std::nullopt;
    OdometryReading now = *frame.odometry;
    // The log's covariance is of the last frame's step; frames between were not tracked.
    if (frame.index != *last_index + 1) now.increment_covariance.reset();
    auto moved = cameraByWheels(*odometry_previous, now, T_robot_camera_previous,
                                frame.T_robot_camera, options);
    return isPlausible(moved.T_previous_camera, timeSinceTracked(dt_s), options)
               ? std::optional(moved)
               : std::nullopt;
  }

  Matrix6 covarianceOf(const Alignment& alignment,
                       const Eigen::Isometry3d& T_previous_camera) const {
    const Matrix6 Ad = adjoint(T_previous_camera.inverse());
    return alignment.covariance + Ad * covariance_key_previous * Ad.transpose() +
           modelError(T_previous_camera);
  }

  /// Before a bare wall brightness slides, and is sure of it.
  bool contradictsWheels(const Alignment& alignment) const {
    if (!by_wheels || !alignment.converged) return false;
    const Eigen::Isometry3d T_previous_camera =
        T_key_previous.inverse() * alignment.T_reference_current;
    const Vector6 e = logSe3(by_wheels->T_previous_camera.inverse() * T_previous_camera);
    const Matrix6 S = by_wheels->covariance + covarianceOf(alignment, T_previous_camera);
    return e.dot(S.llt().solve(e)) > kContradiction;
  }

  void makePreviousTheKey() {
    key = makeReference(previous);
    T_key_previous = Eigen::Isometry3d::Identity();
    covariance_key_previous.setZero();
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

  /// The motion by the wheels, at `kPriorSigmas` times its sigmas, so that their word hardly
  /// counts again when the result is fused with them; without wheels the former velocity.
  MotionPrior priorOfMotion(double dt_s) const {
    if (!by_wheels) return velocity.prior(dt_s, options);
    return {by_wheels->T_previous_camera,
            (kPriorSigmas * kPriorSigmas * by_wheels->covariance).inverse()};
  }

  MotionPrior fromKey(const MotionPrior& of_motion) const {
    return {T_key_previous * of_motion.T_reference_current, of_motion.information};
  }

  /// On a polished floor what it mirrors is left out, as a first alignment with everything tells.
  Alignment alignUnmirrored(const Reference& reference, const RgbdPyramid& current,
                            const MotionPrior& prior,
                            const std::vector<Eigen::Isometry3d>& other_guesses,
                            const AlignmentOptions& how) {
    const Alignment alignment = align(reference, current, prior, other_guesses, how);
    if (!how.use_photometric || !seesTheSame(alignment, options)) return alignment;
    cells.emplace(reference.pyramid.levels.front().camera, pointsFacingUp(reference),
                  current.levels.front(), alignment.T_reference_current.inverse());
    if (!polish.isLikely() || !cells->mirrorSomewhere()) return alignment;
    Reference unmirrored = reference;
    for (auto& points : unmirrored.photometric)
      std::erase_if(points, [&](const auto& point) { return cells->mirrors(point.p_reference); });
    auto again = alignNear(unmirrored, current, prior, alignment.T_reference_current, how);
    if (!again) again = align(unmirrored, current, prior, other_guesses, how);
    return seesTheSame(*again, options) ? *again : alignment;
  }

  /// Brightness and surfaces of what stands still, as seen from about `T_key_camera`. Nothing where
  /// nothing moved.
  std::optional<Alignment> toStandingPart(const RgbdPyramid& current, const MotionPrior& prior,
                                          const Eigen::Isometry3d& T_key_camera,
                                          const Matrix6& covariance, double least_share) {
    if (!options.use_surfaces) return std::nullopt;
    const auto standing = standingPart(*key, current, T_key_camera, covariance, least_share);
    if (!standing) return std::nullopt;
    // The wheels' place is the prior's, where an alignment starts anyhow.
    const auto other_guesses =
        by_wheels ? std::vector<Eigen::Isometry3d>{} : std::vector{T_key_camera};
    const Alignment alignment =
        alignUnmirrored(*standing, current, prior, other_guesses, alignment_options);
    return seesTheSame(alignment, options) ? std::optional(alignment) : std::nullopt;
  }

  /// Wheels tell what moved, however little.
  std::optional<Alignment> toStandingPartByWheels(const RgbdPyramid& current,
                                                  const MotionPrior& prior) {
    const Eigen::Isometry3d& T_previous_camera = by_wheels->T_previous_camera;
    const Matrix6 Ad = adjoint(T_previous_camera.inverse());
    const auto alignment =
        toStandingPart(current, prior, T_key_previous * T_previous_camera,
                       by_wheels->covariance + Ad * covariance_key_previous * Ad.transpose(), 0.0);
    return alignment && !contradictsWheels(*alignment) ? alignment : std::nullopt;
  }

  /// Without wheels the alignment itself tells what moved, better from round to round.
  Alignment refinedByStandingPart(const RgbdPyramid& current, const MotionPrior& prior,
                                  Alignment alignment) {
    constexpr int kRounds = 3;
    constexpr double kSettled_m = 1e-3;
    constexpr double kLeastShare = 0.03;  // its sigmas are small, some surfaces always miss them
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::Isometry3d T_key_camera = alignment.T_reference_current;
      const auto again = toStandingPart(
          current, prior, T_key_camera,
          alignment.covariance + modelError(T_key_previous.inverse() * T_key_camera), kLeastShare);
      if (!again) break;
      alignment = *again;
      const Eigen::Isometry3d change = T_key_camera.inverse() * alignment.T_reference_current;
      if (change.translation().norm() < kSettled_m) break;
    }
    return alignment;
  }

  /// Standing still is a second start, and so are turns where the prior is unsure of them.
  std::vector<Eigen::Isometry3d> otherStarts(const MotionPrior& prior) const {
    const Eigen::Vector3d up_camera =
        T_robot_camera_previous.linear().transpose() * Eigen::Vector3d::UnitZ();
    std::vector<Eigen::Isometry3d> starts = turnedStarts(prior, up_camera);
    starts.insert(starts.begin(), T_key_previous);
    return starts;
  }

  /// Brightness and surfaces, or surfaces alone: before bare walls, in a dark or overexposed image.
  Alignment directly(const RgbdPyramid& current, const MotionPrior& of_motion, double dt_s) {
    const MotionPrior prior = fromKey(of_motion);
    if (by_wheels)
      if (const auto alignment = toStandingPartByWheels(current, prior)) return *alignment;
    // Wheels know better where to start, unless they slip.
    const auto starts = by_wheels ? std::vector<Eigen::Isometry3d>{} : otherStarts(prior);
    Alignment both = alignUnmirrored(*key, current, prior, starts, alignment_options);
    if (by_wheels && !seesTheSame(both, options)) {
      const MotionPrior by_velocity = fromKey(velocity.prior(dt_s, options));
      both =
          alignUnmirrored(*key, current, by_velocity, otherStarts(by_velocity), alignment_options);
    }
    const bool seen = seesTheSame(both, options);
    if (seen && !by_wheels) return refinedByStandingPart(current, prior, both);
    const bool contradicts = seen && contradictsWheels(both);
    if ((seen && !contradicts) || !options.use_surfaces) return both;
    AlignmentOptions surfaces_only = alignment_options;
    surfaces_only.use_photometric = false;
    const Alignment surfaces = align(*key, current, prior, starts, surfaces_only);
    if (seen && !isSound(surfaces, options)) return both;
    motion.contradicts_wheels = contradicts && isFullOfTexture(both);
    return surfaces;
  }

  Alignment estimate(const RgbdPyramid& current, const MotionPrior& of_motion, double dt_s) {
    if (options.engine == "direct") return directly(current, of_motion, dt_s);
    const MotionPrior prior = fromKey(of_motion);
    const auto T_previous_camera =
        openCvOdometry(options.engine, previous, current, of_motion.T_reference_current);
    if (!T_previous_camera) return {};
    return evaluateAt(*key, current, prior, T_key_previous * *T_previous_camera, alignment_options);
  }

  /// Aligns to the key frame, or, when that fails, to the former frame made the key frame.
  bool alignTo(const RgbdPyramid& current, double dt_s) {
    if (current.levels.empty() || previous.levels.empty()) return false;
    const MotionPrior prior = priorOfMotion(dt_s);
    if (!key) makePreviousTheKey();
    for (int attempt = 0; attempt < 2; ++attempt) {
      motion.contradicts_wheels = false;
      cells.reset();
      const Alignment alignment = estimate(current, prior, dt_s);
      const Eigen::Isometry3d T_previous_camera =
          T_key_previous.inverse() * alignment.T_reference_current;
      const bool worth_a_second_look = attempt == 0 && isSurprising(T_previous_camera, prior);
      if (isSound(alignment, options) &&
          isPlausible(T_previous_camera, timeSinceTracked(dt_s), options) && !worth_a_second_look) {
        if (cells) polish.look(*cells);
        motion.T_previous_camera = T_previous_camera;
        motion.covariance = covarianceOf(alignment, T_previous_camera);
        motion.source = sourceOf(alignment);
        falloff.update(alignment.falloff_step, alignment.falloff_information);
        T_key_previous = alignment.T_reference_current;
        covariance_key_previous = alignment.covariance;
        // Where brightness was left out, the pose at the key frame is not worth another look at it.
        if (isWornOut(alignment, options) || motion.contradicts_wheels) key.reset();
        return true;
      }
      if (attempt == 0) makePreviousTheKey();
    }
    key.reset();
    return false;
  }

  void coast(double dt_s) {
    coasted_s += dt_s;
    const MotionPrior prior = priorOfMotion(dt_s);
    motion.covariance = prior.information.inverse();
    if (by_wheels || coasted_s < kLongestCoast_s)
      motion.T_previous_camera = prior.T_reference_current;
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
  self.motion = CameraMotion{};
  RgbdPyramid current = makePyramid(frame, kLevels);
  if (!is_first) {
    self.by_wheels = self.byWheels(frame, dt_s);
    self.alignment_options.lens_falloff = self.falloff.value();
    if (self.alignTo(current, dt_s)) {
      self.coasted_s = 0.0;
    } else {
      self.coast(dt_s);
    }
    self.velocity = {self.motion.T_previous_camera, self.motion.covariance, dt_s};
    self.motion.previous_index = self.last_index;
  }
  self.last_index = frame.index;
  self.last_stamp_s = frame.stamp_s;
  self.odometry_previous = frame.odometry;
  self.T_robot_camera_previous = frame.T_robot_camera;
  self.previous = std::move(current);
  return self.motion;
}

}  // namespace colonnade
