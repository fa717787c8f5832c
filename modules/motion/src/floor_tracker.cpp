// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "floor_tracker.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "colonnade/base/angle.hpp"
#include "fusion.hpp"
#include "residuals.hpp"
#include "standing_test.hpp"

namespace colonnade {
namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;

constexpr int kLevels = 3;
constexpr std::size_t kWitnessLevel = 1;
constexpr double kFarthestWitness_m = 1.0;
constexpr std::size_t kMostWitnesses = 4;
constexpr double kReach_m = 4.0;         ///< farther floor shows a step by a fraction of a pixel
constexpr double kLowestCamera_m = 0.1;  ///< a lower mounting is none: the log does not know it
constexpr int kMinPoints = 60;
constexpr double kMinAgreement = 0.4;  ///< see NormalEquations::gradient_agreement
constexpr double kGainSigma = 0.1;
constexpr double kBiasSigma = 20.0;  ///< brightness levels
/// Regularises what the floor does not show; far wider than any step.
constexpr double kPriorStep_m = 1.0;
constexpr double kPriorTurn = 1.0;
/// A scale that is wrong by e over this way and then drawn anew grows, over many short steps, like
/// independent errors of variance e^2 times this times the step.
constexpr double kScaleHolds_m = 1.0;
constexpr double kProof_m = 0.2;  ///< so long a way proves that the floor is followed
/// Without a look from elsewhere only this part is taken for floor: the robot is about to drive
/// there.
constexpr float kAhead_m = 2.2f;
constexpr float kAside_m = 0.6f;

/// The twist of T_current_reference (of cameras) per planar motion (x, y, phi) of the robot now in
/// its own axes, and the brightness: AlignmentState's unknowns per ours.
Eigen::Matrix<double, 8, 5> planarUnknowns(const Eigen::Isometry3d& T_robot_camera) {
  Eigen::Matrix<double, 6, 3> planar = Eigen::Matrix<double, 6, 3>::Zero();
  planar(0, 0) = planar(1, 1) = planar(5, 2) = 1.0;
  Eigen::Matrix<double, 8, 5> A = Eigen::Matrix<double, 8, 5>::Zero();
  A.topLeftCorner<6, 3>() = -adjoint(T_robot_camera.inverse()) * planar;
  A(6, 3) = A(7, 4) = 1.0;
  return A;
}

/// Brightness at several resolutions. No depth: nothing is known to be hidden.
RgbdPyramid brightnessPyramid(const Frame& frame) {
  Frame flat;
  flat.gray = frame.gray;
  flat.camera = frame.camera;
  flat.depth_m = cv::Mat::zeros(frame.gray.size(), CV_32FC1);
  return makePyramid(flat, kLevels);
}

}  // namespace

cv::Mat floorDepth(const PinholeCamera& camera, const Eigen::Isometry3d& T_robot_camera,
                   double reach_m) {
  cv::Mat depth_m = cv::Mat::zeros(camera.height_px, camera.width_px, CV_32FC1);
  const double height_m = T_robot_camera.translation().z();
  const Eigen::Vector3d up = T_robot_camera.linear().row(2);  // the robot's z in the optical frame
  for (int v = 0; v < camera.height_px; ++v) {
    auto* row = depth_m.ptr<float>(v);
    for (int u = 0; u < camera.width_px; ++u) {
      const double falls = -up.dot(camera.ray(u, v));
      if (falls * reach_m > height_m) row[u] = static_cast<float>(height_m / falls);
    }
  }
  return depth_m;
}

void FloorTracker::makeKey(RgbdPyramid pyramid, const Eigen::Isometry3d& T_robot_camera) {
  if (key_) {
    const Pose2 T_now_key = previous_.T_key_robot.inverse();
    for (Witness& witness : witnesses_) witness.T_key_robot = T_now_key * witness.T_key_robot;
    witnesses_.push_back({key_->pyramid.levels[kWitnessLevel], T_robot_camera_key_, T_now_key});
    std::erase_if(witnesses_, [](const Witness& witness) {
      return witness.T_key_robot.translation().norm() > kFarthestWitness_m;
    });
    if (witnesses_.size() > kMostWitnesses) witnesses_.erase(witnesses_.begin());
  } else {
    witnesses_.clear();
  }
  key_ = Reference{std::move(pyramid), {}, {}};
  T_robot_camera_key_ = T_robot_camera;
  previous_ = {};
  by_wheels_ = MotionSum();
  placePoints();
}

void FloorTracker::placePoints() {
  const auto& levels = key_->pyramid.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    PyramidLevel level = levels[i];
    level.depth_m = floorDepth(level.camera, T_robot_camera_key_, kReach_m);
    key_->photometric.push_back(selectPhotometricPoints(level, i == 0 ? 4 : i == 1 ? 3 : 2, 3.0f));
  }
  StandingTest test(levels.front().camera);
  for (const Witness& witness : witnesses_) {
    AlignmentState state;
    state.T_current_reference = witness.T_robot_camera.inverse() *
                                witness.T_key_robot.inverse().toIsometry3() * T_robot_camera_key_;
    test.look(key_->photometric[kWitnessLevel], witness.level, state);
  }
  const auto isFloor = [&](const PhotometricPoint& point) {
    if (!witnesses_.empty())
      return test.verdict(point.p_reference) == StandingTest::Verdict::kFloor;
    const Eigen::Vector3f p_robot = T_robot_camera_key_.cast<float>() * point.p_reference;
    return p_robot.x() < kAhead_m && std::abs(p_robot.y()) < kAside_m;
  };
  for (auto& points : key_->photometric)
    std::erase_if(points, [&](const auto& point) { return !isFloor(point); });
}

FloorTracker::Verdict FloorTracker::judgeByWheels(const Placed& placed) const {
  if (!by_wheels_) return Verdict::kOpen;
  const Pose2& T_key_wheels = by_wheels_->T_start_now();
  const double way_m = T_key_wheels.translation().norm();
  Eigen::Matrix3d into_key = Eigen::Matrix3d::Identity();
  into_key.topLeftCorner<2, 2>() = placed.T_key_robot.rotation();
  Eigen::Matrix3d S =
      by_wheels_->covariance() + into_key * placed.covariance * into_key.transpose();
  const double way = std::hypot(options_.floor_scale, options_.model_error) * way_m;
  const double turn = options_.model_error * T_key_wheels.phi;
  S.diagonal() += Eigen::Vector3d(way * way, way * way, turn * turn);
  Eigen::Vector3d e = placed.T_key_robot.vector() - T_key_wheels.vector();
  e.z() = wrapAngle(e.z());
  const double surprise = e.dot(S.llt().solve(e));
  if (!(surprise < kConflict)) return Verdict::kContradicts;
  const double proof_m = std::min(kProof_m, 0.6 * options_.floor_keyframe_m);
  return way_m > proof_m && surprise < kUsual ? Verdict::kAgrees : Verdict::kOpen;
}

void FloorTracker::reset() {
  key_.reset();
  contradicts_ = false;
}

bool FloorTracker::leaveOutMirrored(const RgbdPyramid& current, const Pose2& T_key_robot,
                                    const Eigen::Isometry3d& T_robot_camera) {
  // Where most of the picture is mirrored the alignment follows that: ways are the wheels'.
  Pose2 T_key_now = T_key_robot;
  if (by_wheels_) {
    T_key_now.x = by_wheels_->T_start_now().x;
    T_key_now.y = by_wheels_->T_start_now().y;
  }
  const MirroredCells cells(
      key_->pyramid.levels.front().camera, key_->photometric.front(), current.levels.front(),
      T_robot_camera.inverse() * T_key_now.inverse().toIsometry3() * T_robot_camera_key_);
  polish_.look(cells);
  if (!polish_.isLikely() || !cells.mirrorSomewhere()) return false;
  for (auto& points : key_->photometric)
    std::erase_if(points, [&](const auto& point) { return cells.mirrors(point.p_reference); });
  return true;
}

std::optional<FloorTracker::Placed> FloorTracker::align(
    const RgbdPyramid& current, const Pose2& guess_T_key_robot,
    const Eigen::Isometry3d& T_robot_camera) const {
  const Eigen::Matrix<double, 8, 5> A = planarUnknowns(T_robot_camera);
  Placed placed;
  placed.T_key_robot = guess_T_key_robot;
  AlignmentState state;
  ResidualBuffer buffer;
  const auto place = [&] {
    state.T_current_reference =
        T_robot_camera.inverse() * placed.T_key_robot.inverse().toIsometry3() * T_robot_camera_key_;
  };
  const auto equationsAt = [&](const std::vector<PhotometricPoint>& points, std::size_t level) {
    return photometricEquations(points, current.levels[level], state, 0.0, 0.0, buffer);
  };
  const auto normal = [&](const NormalEquations& e, double scale) {
    Matrix5 H = scale / options_.photometric_correlation * A.transpose() * e.H * A;
    H(0, 0) += 1.0 / (kPriorStep_m * kPriorStep_m);
    H(1, 1) += 1.0 / (kPriorStep_m * kPriorStep_m);
    H(2, 2) += 1.0 / (kPriorTurn * kPriorTurn);
    H(3, 3) += 1.0 / (kGainSigma * kGainSigma);
    H(4, 4) += 1.0 / (kBiasSigma * kBiasSigma);
    return H;
  };
  const auto iterate = [&](const std::vector<PhotometricPoint>& points, std::size_t level) {
    for (int i = 0; i < 8; ++i) {
      const NormalEquations e = equationsAt(points, level);
      Vector5 g = A.transpose() * e.g / options_.photometric_correlation;
      g(3) += state.gain / (kGainSigma * kGainSigma);
      g(4) += state.bias / (kBiasSigma * kBiasSigma);
      const Vector5 dx = -normal(e, 1.0).ldlt().solve(g);
      if (!dx.allFinite()) return false;
      placed.T_key_robot = placed.T_key_robot * Pose2{dx(0), dx(1), dx(2)};
      place();
      state.gain = std::clamp(state.gain + dx(3), -0.5, 0.5);
      state.bias = std::clamp(state.bias + dx(4), -80.0, 80.0);
      if (dx.head<3>().norm() < 1e-5) break;
    }
    return true;
  };

  place();
  for (std::size_t level = current.levels.size(); level-- > 0;)
    if (!iterate(key_->photometric[level], level)) return std::nullopt;
  const NormalEquations e = equationsAt(key_->photometric[0], 0);
  if (e.count < kMinPoints || e.gradient_agreement < kMinAgreement) return std::nullopt;
  const double scale = std::pow(e.sigma / e.full_sigma, 2);
  placed.covariance = normal(e, scale).inverse().topLeftCorner<3, 3>();
  placed.share = static_cast<double>(e.count) / static_cast<double>(key_->photometric[0].size());
  if (!placed.covariance.allFinite()) return std::nullopt;
  return placed;
}

std::optional<MotionIncrement> FloorTracker::track(const Frame& frame,
                                                   const MotionIncrement& guess) {
  contradicts_ = false;
  const bool can = !frame.gray.empty() && frame.camera.isCalibrated() &&
                   frame.T_robot_camera.translation().z() > kLowestCamera_m;
  if (!can) {
    key_.reset();
    return std::nullopt;
  }
  RgbdPyramid current = brightnessPyramid(frame);
  if (!key_) {
    makeKey(std::move(current), frame.T_robot_camera);
    return std::nullopt;
  }
  has_wheels_ = has_wheels_ || guess.isMeasured();
  if (!guess.isMeasured()) by_wheels_.reset();
  if (by_wheels_) by_wheels_->add(guess);
  const Pose2 T_key_guessed = previous_.T_key_robot * guess.T_previous_robot;
  auto placed = align(current, T_key_guessed, frame.T_robot_camera);
  const Verdict verdict = placed ? judgeByWheels(*placed) : Verdict::kOpen;
  contradicts_ = believed_ && verdict == Verdict::kContradicts;
  if (verdict == Verdict::kAgrees) believed_ = true;
  if (verdict == Verdict::kContradicts) {
    believed_ = false;
    placed.reset();
  }
  if (placed && leaveOutMirrored(current, placed->T_key_robot, frame.T_robot_camera))
    placed = align(current, T_key_guessed, frame.T_robot_camera);
  if (!placed) {
    key_.reset();
    makeKey(std::move(current), frame.T_robot_camera);
    return std::nullopt;
  }
  MotionIncrement increment;
  increment.source = MotionSource::kFloor;
  increment.T_previous_robot = previous_.T_key_robot.inverse() * placed->T_key_robot;
  // Errors e of T exp(e): that of the former frame is carried here, the sum turned into its axes.
  const Pose2 T_robot_previous = increment.T_previous_robot.inverse();
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  carry.topLeftCorner<2, 2>() = T_robot_previous.rotation();
  carry(0, 2) = T_robot_previous.y;
  carry(1, 2) = -T_robot_previous.x;
  const double way_m = increment.T_previous_robot.translation().norm();
  const double way = std::hypot(options_.model_error * way_m,
                                options_.floor_scale * std::sqrt(way_m * kScaleHolds_m));
  const double turn = options_.model_error * increment.T_previous_robot.phi;
  Eigen::Matrix3d covariance =
      placed->covariance + carry * previous_.covariance * carry.transpose();
  covariance.diagonal() += Eigen::Vector3d(way * way + 1e-8, way * way + 1e-8, turn * turn + 1e-8);
  Eigen::Matrix3d into_previous = Eigen::Matrix3d::Identity();
  into_previous.topLeftCorner<2, 2>() = increment.T_previous_robot.rotation();
  increment.covariance = into_previous * covariance * into_previous.transpose();

  previous_ = *placed;
  if (placed->T_key_robot.translation().norm() > options_.floor_keyframe_m ||
      std::abs(placed->T_key_robot.phi) > options_.keyframe_angle ||
      placed->share < options_.keyframe_share)
    makeKey(std::move(current), frame.T_robot_camera);
  return believed_ || !has_wheels_ ? std::optional(increment) : std::nullopt;
}

}  // namespace colonnade
