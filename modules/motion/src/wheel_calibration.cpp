// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "fusion.hpp"

namespace colonnade {
namespace {

/// A piece of the way ends after the one or the other.
constexpr double kPieceWay_m = 0.5;
constexpr double kPieceTurn = 0.5;
/// A way, or a turn, of fewer of the camera's sigmas is none.
constexpr double kMoved = 5.0;
/// Tyres wear and floors change: over so long a way what was learnt fades.
constexpr double kFades_m = 200.0;
constexpr double kMostSigmas = 3.0;
constexpr double kMost = 0.2;

Eigen::Vector2d wayAndTurn(const Pose2& motion) { return {motion.x, motion.phi}; }

Eigen::Matrix2d wayAndTurn(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix2d part;
  part << covariance(0, 0), covariance(0, 2), covariance(2, 0), covariance(2, 2);
  return part;
}

}  // namespace

WheelCalibration::WheelCalibration(const MotionOptions& options)
    : enabled_(options.calibrate_wheels),
      prior_variances_(
          Eigen::Vector3d(options.odometry_along, options.odometry_heading, options.odometry_turn)
              .cwiseAbs2()),
      covariance_(prior_variances_.asDiagonal()) {}

MotionIncrement WheelCalibration::corrected(MotionIncrement wheels) const {
  Pose2& motion = wheels.T_previous_robot;
  const double way_m = motion.x / (1.0 + errors_(0));
  const double phi = (motion.phi - errors_(1) * way_m) / (1.0 + errors_(2));
  // The way lies along the mean of the headings before and after.
  const Eigen::Vector2d p =
      Eigen::Rotation2Dd(0.5 * (phi - motion.phi)) * motion.translation() / (1.0 + errors_(0));
  motion = {p.x(), p.y(), wrapAngle(phi)};
  return wheels;
}

void WheelCalibration::learn(const MotionIncrement& wheels, const MotionIncrement& camera) {
  if (!enabled_) return;
  Eigen::Vector3d e =
      corrected(wheels).T_previous_robot.vector() - camera.T_previous_robot.vector();
  e.z() = wrapAngle(e.z());
  const Eigen::Matrix3d S = wheels.covariance + camera.covariance;
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  if (llt.info() != Eigen::Success || !(e.dot(llt.solve(e)) < kUsual)) return;
  Eigen::Vector2d excess =
      wayAndTurn(wheels.T_previous_robot) - wayAndTurn(camera.T_previous_robot);
  excess.y() = wrapAngle(excess.y());
  piece_.camera += wayAndTurn(camera.T_previous_robot);
  piece_.excess += excess;
  piece_.camera_covariance += wayAndTurn(camera.covariance);
  piece_.covariance += wayAndTurn(S);
  if (std::abs(piece_.camera.x()) < kPieceWay_m && std::abs(piece_.camera.y()) < kPieceTurn) return;
  learn(piece_);
  piece_ = {};
}

void WheelCalibration::learn(const Piece& piece) {
  Eigen::Vector2d moved = piece.camera;
  for (int i = 0; i < 2; ++i)
    if (std::pow(moved(i), 2) < kMoved * kMoved * piece.camera_covariance(i, i)) moved(i) = 0.0;
  Eigen::Matrix<double, 2, 3> H;
  H << moved.x(), 0.0, 0.0,  //
      0.0, moved.x(), moved.y();
  const Eigen::Vector2d nu = piece.excess - H * errors_;
  const Eigen::Matrix2d S = H * covariance_ * H.transpose() + piece.covariance;
  const Eigen::LLT<Eigen::Matrix2d> llt(S);
  if (llt.info() != Eigen::Success) return;
  const Eigen::Matrix<double, 3, 2> K = llt.solve(H * covariance_).transpose();
  errors_ += K * nu;
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K * H;
  covariance_ = A * covariance_ * A.transpose() + K * piece.covariance * K.transpose();
  forget(std::abs(moved.x()));
  const Eigen::Vector3d most = (kMostSigmas * prior_variances_.cwiseSqrt()).cwiseMin(kMost);
  errors_ = errors_.cwiseMax(-most).cwiseMin(most);
}

/// Back towards the prior, in which it would end (an Ornstein-Uhlenbeck process).
void WheelCalibration::forget(double way_m) {
  const double kept = std::exp(-way_m / kFades_m);
  errors_ *= kept;
  covariance_ *= kept * kept;
  covariance_.diagonal() += (1.0 - kept * kept) * prior_variances_;
}

}  // namespace colonnade
