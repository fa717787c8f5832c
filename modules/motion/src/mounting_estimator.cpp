// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/motion/mounting_estimator.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "colonnade/frames/floor_plane.hpp"
#include "floor_fit.hpp"
#include "se3.hpp"

namespace colonnade {
namespace {

constexpr double kGate = 16.27;            ///< chi squared, 3 degrees of freedom, 0.1 %
constexpr double kSystematicTilt = 0.006;  ///< rad: distortion of the depth, the same in each frame
constexpr double kSystematicHeight_m = 0.012;
constexpr double kSteepest = 0.98;    ///< cosine: a camera nearer to the vertical has no heading
constexpr int kRefusalsToReset = 10;  ///< floor fits refused in a row before the floor is believed

}  // namespace

struct MountingEstimator::Impl {
  Impl(const MotionOptions& motion_options, std::shared_ptr<CameraTracker> camera_tracker)
      : options(motion_options), tracker(std::move(camera_tracker)) {}

  MotionOptions options;
  std::shared_ptr<CameraTracker> tracker;
  std::optional<bool> per_frame;
  bool has_state = false;
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();  ///< in the optical frame
  double height_m = 0.0;
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();     ///< about the robot's x and y, height
  Eigen::Matrix3d step = Eigen::Matrix3d::Zero();  ///< covariance of this frame's change
  int refused = 0;
  MountingUncertainty uncertainty;

  Eigen::Isometry3d levelled() const { return cameraAboveFloor(up, height_m); }

  void start(const Frame& frame) {
    up = frame.T_robot_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
    height_m = frame.T_robot_camera.translation().z();
    P.setZero();
    P.diagonal() << 0.03, 0.03, 0.04;  // 10 degrees, 0.2 m
    has_state = true;
    if (frame.depth_m.empty() || !frame.camera.isCalibrated()) return;
    // The log's mounting may be a guess: let the whole depth image say where the floor is.
    FloorPrior prior;
    prior.up_camera = up;
    const auto floor = fitFloorPlane(frame.depth_m, frame.camera, prior);
    if (!floor) return;
    up = floor->normal_camera;
    height_m = floor->height_m;
    P.diagonal() << 4e-4, 4e-4, 4e-4;
  }

  void predict(const CameraMotion& motion) {
    const Eigen::Isometry3d T_robot_camera_before = levelled();
    const Eigen::Vector3d p_robot = T_robot_camera_before * motion.T_previous_camera.translation();
    up = motion.T_previous_camera.linear().transpose() * up;
    height_m = p_robot.z();
    const Eigen::Isometry3d T_robot_camera = levelled();
    // Tilt errors keep their direction in space; the robot's axes turn under them. A tilt error
    // also climbs with the way: height' = height + (alpha y - beta x) of the way.
    const Eigen::Matrix3d R_now_before =
        T_robot_camera.linear() *
        (T_robot_camera_before.linear() * motion.T_previous_camera.linear()).transpose();
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F.topLeftCorner<2, 2>() = R_now_before.topLeftCorner<2, 2>();
    const Eigen::Vector3d way =
        T_robot_camera_before.linear() * motion.T_previous_camera.translation();
    F(2, 0) = way.y();
    F(2, 1) = -way.x();
    Eigen::Matrix<double, 3, 6> G = Eigen::Matrix<double, 3, 6>::Zero();
    G.block<2, 3>(0, 3) = T_robot_camera.linear().topRows<2>();
    G.block<1, 3>(2, 0) = T_robot_camera.linear().row(2);
    step = G * motion.covariance * G.transpose();
    step.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 4e-6);
    P = F * P * F.transpose() + step;
  }

  bool update(const FloorFit& fit) {
    const Eigen::Isometry3d T_robot_camera = levelled();
    // up_true = up + R^T (rotation x z): the measured normal in the robot's axes is
    // (beta, -alpha, 1) for rotations alpha about x and beta about y of the true mounting.
    const Eigen::Vector3d normal = T_robot_camera.linear() * fit.up;
    const Eigen::Vector3d innovation(normal.y(), -normal.x(), fit.height_m - height_m);
    const Eigen::Vector3d a = T_robot_camera.linear() * fit.tangent_a;
    const Eigen::Vector3d b = T_robot_camera.linear() * fit.tangent_b;
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    J.topLeftCorner<2, 2>() << a.y(), b.y(), -a.x(), -b.x();
    const Eigen::Matrix3d R = J * fit.covariance * J.transpose();
    const Eigen::Matrix3d S = P + R;
    const Eigen::LLT<Eigen::Matrix3d> llt(S);
    if (llt.info() != Eigen::Success) return false;
    if (innovation.dot(llt.solve(innovation)) > kGate && ++refused < kRefusalsToReset) return false;
    const Eigen::Matrix3d K =
        refused >= kRefusalsToReset ? Eigen::Matrix3d::Identity() : llt.solve(P).transpose().eval();
    refused = 0;
    const Eigen::Vector3d dx = K * innovation;
    const Eigen::Vector3d up_robot = Eigen::Vector3d(-dx.y(), dx.x(), 1.0).normalized();
    up = (T_robot_camera.linear().transpose() * up_robot).normalized();
    height_m += dx.z();
    const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K;
    P = A * P * A.transpose() + K * R * K.transpose();
    step = K * S * K.transpose();
    return true;
  }
};

MountingEstimator::MountingEstimator(const MotionOptions& options,
                                     std::shared_ptr<CameraTracker> tracker)
    : impl_(std::make_unique<Impl>(options, std::move(tracker))) {}
MountingEstimator::~MountingEstimator() = default;

void MountingEstimator::refine(Frame& frame) {
  Impl& self = *impl_;
  if (!self.per_frame) {
    self.per_frame = self.options.mounting == "per_frame" ||
                     (self.options.mounting == "auto" && !frame.odometry && !frame.depth_m.empty());
  }
  if (!*self.per_frame) return;
  const CameraMotion& motion = self.tracker->track(frame);
  if (!self.has_state) {
    self.start(frame);
  } else {
    self.predict(motion);
  }
  self.uncertainty.floor_seen = false;
  if (!frame.depth_m.empty() && frame.camera.isCalibrated()) {
    const FloorSearch search{
        std::clamp(3.0 * std::sqrt(std::max(self.P(0, 0), self.P(1, 1))), 0.02, 0.35),
        std::clamp(3.0 * std::sqrt(self.P(2, 2)), 0.02, 0.4)};
    const auto fit = fitFloorNear(frame.depth_m, frame.camera, self.up, self.height_m, search);
    if (fit) self.uncertainty.floor_seen = self.update(*fit);
  }
  self.uncertainty.covariance = self.P;
  self.uncertainty.covariance.diagonal() +=
      Eigen::Vector3d(kSystematicTilt, kSystematicTilt, kSystematicHeight_m).cwiseAbs2();
  self.uncertainty.step_covariance = self.step;
  if (std::abs(self.up.z()) < kSteepest) frame.T_robot_camera = self.levelled();
}

const MountingUncertainty& MountingEstimator::uncertainty() const { return impl_->uncertainty; }
bool MountingEstimator::isPerFrame() const { return impl_->per_frame.value_or(false); }

}  // namespace colonnade
