// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "colonnade/filter/covariance.hpp"
#include "colonnade/filter/filter_options.hpp"
#include "colonnade/filter/health.hpp"
#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/filter/resting_map.hpp"
#include "colonnade/filter/sensor_errors.hpp"
#include "colonnade/filter/state.hpp"

namespace colonnade {

/// A measurement held to be of a landmark of the map.
struct Match {
  LandmarkId landmark{};
  Measurement measurement;
};

/// How much more often one has to measure when each error resembles the former one: for errors
/// whose correlation falls as rho = exp(-interval / correlation), the variance of their mean is (1
/// + rho) / (1 - rho) times that of independent ones (first-order autoregressive process; Box,
/// Jenkins, Reinsel, Time Series Analysis, section 3.2). Intervals under 5 ms count as 5 ms.
double correlatedNoiseScale(double interval_s, double correlation_s);

/// What the filter expects against what was measured.
struct Innovation {
  MeasurementVector nu;      ///< measured minus predicted, angles wrapped
  MeasurementCovariance S;   ///< H P H^T + R
  double distance2 = 0.0;    ///< nu^T S^-1 nu
  bool within_gate = false;  ///< distance2 below the chi-square bound of nu's size
};

/// The robot alone.
struct RobotEstimate {
  Pose2 T_world_robot;
  Eigen::Matrix3d covariance;  ///< of (x, y, phi)
};

/// EKF-SLAM of a planar robot with landmarks of several kinds in one state. Starts at the origin of
/// the world without uncertainty. Input that is not finite, a motion covariance with a negative
/// diagonal and an innovation covariance that is not positive definite are refused before they
/// touch the state, and counted in health().
class EkfSlam {
 public:
  explicit EkfSlam(const FilterOptions& options) : options_(options) {}
  /// Goes on from a state saved before: blocks in the order of their identities, offsets without
  /// gaps, P symmetric. The robot is put with placeRobot().
  EkfSlam(const FilterOptions& options, State state);

  /// Puts the robot at a pose known by other means, independent of everything in the state.
  void placeRobot(const Pose2& T_world_robot, const Eigen::Matrix3d& covariance);
  /// From now on the blocks the state holds keep their values and covariance; what is not known of
  /// them still counts in every correction (Schmidt's consider filter). Blocks added later are
  /// estimated.
  void fixMap() { fixed_ = state_.x.size() - 3; }
  bool isFixed(LandmarkId block) const;
  /// From now on the errors of the sensor that reads point landmarks are estimated with everything
  /// else, from none with these standard deviations. To be called once.
  void addSensor(const SensorErrors& sigmas);
  std::optional<SensorEstimate> sensor() const;

  /// Moves the robot by u with covariance Q (x, y, phi in the former robot's axes). Refused: false.
  bool predict(const Pose2& T_previous_robot, const Eigen::Matrix3d& Q);

  /// Nothing for an unknown landmark, a non-finite measurement or a singular S.
  std::optional<Innovation> innovation(LandmarkId landmark, const Measurement& measurement) const;
  /// A cheap look before innovation(): false only where its distance2 would be larger, as far as
  /// positions tell (a point and a measurement with range).
  bool mayBeWithin(LandmarkId landmark, const Measurement& measurement, double distance2) const;

  /// What a match would make of the robot, but for the turn of the world that the invariant
  /// correction takes along; the robot as it is when it could not be used.
  RobotEstimate robotAfter(const Match& match, double noise_scale) const;

  /// The squared Mahalanobis distance of all matches together; nothing when S is singular.
  std::optional<double> jointDistance2(std::span<const Match> matches) const;

  /// The innovations of several pairings, stacked, with their covariance S = H P H^T + R. A
  /// landmark and a measurement may stand in several of them. All landmarks must be known.
  struct JointInnovation {
    Eigen::VectorXd nu;
    Eigen::MatrixXd S;
    Eigen::MatrixXd R;
  };
  JointInnovation jointInnovation(std::span<const Match> matches) const;

  /// One joint correction with all matches that are finite and within their gate; the others are
  /// counted. Returns which were used, one flag per match. `noise_scale` widens R for the
  /// correction but not for the gate: what a measurement is worth, beside how far it may lie off.
  std::vector<bool> update(std::span<const Match> matches, double noise_scale = 1.0);

  /// A new landmark from one measurement with range or of a floor edge. Nothing when not finite.
  std::optional<LandmarkId> addLandmark(const Measurement& measurement);

  /// Remembers the present pose, so that a bearing of now can be combined with a later one.
  LandmarkId addPoseClone();
  /// What the two bearings say together, with its inverse depth's standard deviation.
  struct Parallax {
    double baseline_m = 0.0;
    double angle = 0.0;
    double inverse_depth = 0.0;
    double inverse_depth_sigma = 0.0;
  };
  std::optional<Parallax> parallax(LandmarkId clone, const Measurement& first,
                                   const Measurement& now) const;
  /// A new inverse-depth landmark from a bearing at the clone and one of now.
  std::optional<LandmarkId> addLandmark(LandmarkId clone, const Measurement& first,
                                        const Measurement& now);
  /// A new inverse-depth landmark on the ray of a bearing at the clone, its inverse depth (1/m)
  /// known otherwise. Nothing when not finite.
  std::optional<LandmarkId> addLandmarkOnRay(LandmarkId clone, const Measurement& bearing,
                                             double inverse_depth, double inverse_depth_sigma);
  void remove(LandmarkId block);

  /// H P H^T of a linear function of the state.
  Eigen::MatrixXd covarianceOf(const SparseJacobian& H) const;
  /// A correction by what is known beside measurements: H dx = nu with covariance R. False, and
  /// nothing changed, when it is not finite or singular.
  bool constrain(const SparseJacobian& H, const Eigen::VectorXd& nu, const Eigen::MatrixXd& R);

  /// Turns inverse-depth blocks whose linearity index allows into points; returns which.
  std::vector<LandmarkId> settleInverseDepths();

  /// A building axis in the direction (robot's axes) seen now, with its standard deviation.
  LandmarkId addAxis(double direction, double sigma);
  std::optional<Innovation> axisInnovation(LandmarkId axis, double direction, double sigma) const;
  /// Heading correction by a wall direction held to be of this axis; noise_scale as in update().
  /// False: refused.
  bool updateAxis(LandmarkId axis, double direction, double sigma, double noise_scale = 1.0);

  const State& state() const { return state_; }  ///< what is active
  Pose2 pose() const { return state_.T_world_robot(); }
  Eigen::Matrix3d poseCovariance() const { return state_.P.topLeftCorner<3, 3>(); }
  Evidence& evidence(LandmarkId landmark);
  const InnovationHealth& health() const { return health_; }
  InnovationHealth& health() { return health_; }
  const FilterOptions& options() const { return options_; }

  /// Lets the landmarks around the robot's way be worked with, and with them those of `needed` and
  /// the points that one of `open` (measurements with range) may be of, while the others rest
  /// (RestingMap): what is active grows to twice `active_landmarks` before anything rests. Without
  /// need nothing happens. state(), updates and gates know active landmarks only.
  void focus(std::span<const LandmarkId> needed, std::span<const Measurement> open = {});
  bool knows(LandmarkId landmark) const { return state_.find(landmark) || isResting(landmark); }
  bool isResting(LandmarkId landmark) const { return resting_.find(landmark) != nullptr; }
  const RestingMap& resting() const { return resting_; }
  /// Nothing rests until the next focus(). To be called before the heading becomes uncertain by
  /// more than motion makes it: resting points are transported when they enter, with the heading's
  /// covariance of that moment.
  void wakeAll();
  /// Resting points that one of the measurements (those with range) may be of.
  std::vector<LandmarkId> restingNear(std::span<const Measurement> measurements) const;
  /// The state with all landmarks active, up to date. A copy of everything where some rest.
  State fullState() const;

  /// Where a point landmark is, a resting one when it came to rest; nothing for one that is no
  /// landmark or no more than a direction.
  std::optional<Eigen::Vector2d> placeOf(LandmarkId landmark) const;

  /// All landmarks as exporters want them.
  LandmarkMap landmarkMap() const;

 private:
  LandmarkId nextId() { return LandmarkId{next_id_++}; }
  /// restingNear() of active points.
  std::vector<LandmarkId> activeNear(std::span<const Measurement> measurements) const;

  FilterOptions options_;
  State state_;
  RestingMap resting_;
  InnovationHealth health_;
  std::int32_t next_id_ = 0;
  Eigen::Index fixed_ = 0;  ///< entries of x after the robot that no correction moves
};

}  // namespace colonnade
