// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/ekf_slam.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/covariance.hpp"
#include "colonnade/filter/gate.hpp"
#include "first_look.hpp"
#include "sensed.hpp"

namespace colonnade {
namespace {

/// Farther than any sensor of a robot sees.
constexpr double kLongestRange_m = 1e4;

/// Finite, and a range, where there is one, that a sensor can have measured.
bool isUsable(const Measurement& m) {
  if (!m.z.allFinite() || !m.R.allFinite() || !m.p_robot_camera.allFinite()) return false;
  if (!m.hasRange()) return true;
  const bool is_line = m.kind == LandmarkKind::kFloorEdge;  // the distance to a line has a sign
  return std::abs(m.z(1)) < kLongestRange_m && (is_line || m.z(1) > 0.0);
}

bool isCovariance(const Eigen::MatrixXd& Q) {
  return Q.allFinite() && (Q.diagonal().array() >= 0.0).all();
}

/// Several measurements as one: innovation, Jacobian and noise stacked.
struct Stack {
  SparseJacobian H;
  Eigen::VectorXd nu;
  Eigen::MatrixXd R;
};

Stack stack(const State& state, std::span<const Match> matches) {
  Eigen::Index rows = 0;
  for (const Match& match : matches) rows += match.measurement.z.size();
  Stack s{SparseJacobian(rows), Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, rows)};
  Eigen::MatrixXd H_robot(rows, 3), H_sensor;
  if (state.sensor) H_sensor.setZero(rows, sizeOf(BlockKind::kSensor));
  Eigen::Index row = 0;
  for (const Match& match : matches) {
    const Block& block = *state.find(match.landmark);
    auto predicted = predictMeasurement(state.T_world_robot(), block.block_kind,
                                        state.values(block), match.measurement);
    const Eigen::Index size = predicted.z.size();
    if (const Block* sensor = sensorOf(state, match.measurement))
      H_sensor.middleRows(row, size) =
          readWith(errorsOf(state, sensor), match.measurement, predicted);
    s.nu.segment(row, size) = innovationOf(match.measurement, predicted.z);
    s.R.block(row, row, size, size) = noiseOf(match.measurement);
    H_robot.middleRows(row, size) = predicted.H_robot;
    s.H.add(row, block.offset, predicted.H_block);
    row += size;
  }
  s.H.add(0, 0, std::move(H_robot));
  if (state.sensor) s.H.add(0, state.find(*state.sensor)->offset, std::move(H_sensor));
  return s;
}

std::optional<double> mahalanobis2(const Eigen::VectorXd& nu, const Eigen::MatrixXd& S) {
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const double distance2 = nu.dot(llt.solve(nu));
  return std::isfinite(distance2) ? std::optional(distance2) : std::nullopt;
}

Eigen::MatrixXd innovationCovariance(const State& state, const Stack& s) {
  return bothSides(s.H, state.P) + s.R;
}

}  // namespace

/// Frames nearer in time than this say no more together than two this far apart would.
constexpr double kShortestInterval_s = 0.005;

double correlatedNoiseScale(double interval_s, double correlation_s) {
  if (correlation_s <= 0.0) return 1.0;
  const double rho = std::exp(-std::max(interval_s, kShortestInterval_s) / correlation_s);
  return (1.0 + rho) / (1.0 - rho);
}

bool EkfSlam::predict(const Pose2& T_previous_robot, const Eigen::Matrix3d& Q) {
  if (!T_previous_robot.vector().allFinite() || !isCovariance(Q)) {
    health_.refuse("motion not finite");
    return false;
  }
  predictRobot(state_, T_previous_robot, Q);
  resting_.workOff();
  return true;
}

std::optional<Innovation> EkfSlam::innovation(LandmarkId landmark,
                                              const Measurement& measurement) const {
  const Block* block = state_.find(landmark);
  if (!block || !isUsable(measurement)) return std::nullopt;
  const Match match{landmark, measurement};
  const Stack s = stack(state_, {&match, 1});
  Innovation innovation;
  innovation.nu = s.nu;
  innovation.S = innovationCovariance(state_, s);
  const auto distance2 = mahalanobis2(s.nu, innovation.S);
  if (!distance2) return std::nullopt;
  innovation.distance2 = *distance2;
  innovation.within_gate =
      *distance2 <= chiSquareQuantile(options_.gate_probability, static_cast<int>(s.nu.size()));
  return innovation;
}

bool EkfSlam::mayBeWithin(LandmarkId landmark, const Measurement& measurement,
                          double distance2) const {
  const Block* block = state_.find(landmark);
  if (!block || block->block_kind != BlockKind::kPoint || !measurement.hasRange()) return true;
  return !FirstLook(pose(), poseCovariance(), seenWith(state_, measurement))
              .rulesOut(state_.values(*block), state_.P.diagonal().segment<2>(block->offset).sum(),
                        distance2);
}

RobotEstimate EkfSlam::robotAfter(const Match& match, double noise_scale) const {
  RobotEstimate robot{pose(), poseCovariance()};
  if (!state_.find(match.landmark) || !isUsable(match.measurement)) return robot;
  const Stack s = stack(state_, {&match, 1});
  const Eigen::LLT<Eigen::MatrixXd> llt(bothSides(s.H, state_.P) + noise_scale * s.R);
  if (llt.info() != Eigen::Success) return robot;
  Eigen::MatrixXd PHt = Eigen::MatrixXd::Zero(3, s.H.rows);
  for (const auto& part : s.H.parts)
    PHt.middleCols(part.row, part.H.rows()) +=
        state_.P.block(0, part.column, 3, part.H.cols()) * part.H.transpose();
  const Eigen::Vector3d x = robot.T_world_robot.vector() + PHt * llt.solve(s.nu);
  robot.T_world_robot = {x(0), x(1), wrapAngle(x(2))};
  robot.covariance -= PHt * llt.solve(PHt.transpose());
  return robot;
}

std::optional<double> EkfSlam::jointDistance2(std::span<const Match> matches) const {
  if (matches.empty()) return 0.0;
  const Stack s = stack(state_, matches);
  return mahalanobis2(s.nu, innovationCovariance(state_, s));
}

EkfSlam::JointInnovation EkfSlam::jointInnovation(std::span<const Match> matches) const {
  const Stack s = stack(state_, matches);
  return {s.nu, innovationCovariance(state_, s), s.R};
}

std::vector<bool> EkfSlam::update(std::span<const Match> matches, double noise_scale) {
  std::vector<bool> used(matches.size(), false);
  std::vector<Match> accepted;
  std::vector<double> distances;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (!isUsable(match.measurement)) {
      health_.refuse("measurement not finite");
      continue;
    }
    const auto predicted = innovation(match.landmark, match.measurement);
    if (!predicted) {
      health_.refuse(state_.find(match.landmark) ? "innovation covariance singular"
                                                 : "unknown landmark");
    } else if (!predicted->within_gate) {
      health_.refuse(std::string("outside the gate: ") + name(match.measurement.kind));
    } else {
      used[i] = true;
      accepted.push_back(match);
      distances.push_back(predicted->distance2);
    }
  }
  if (accepted.empty()) return used;
  const Stack s = stack(state_, accepted);
  if (!correct(state_, s.H, s.nu, noise_scale * s.R, options_.invariant, fixed_)) {
    health_.refuse("joint innovation covariance singular");
    return std::vector<bool>(matches.size(), false);
  }
  for (std::size_t i = 0; i < accepted.size(); ++i)
    health_.accept(accepted[i].measurement.kind, distances[i],
                   static_cast<int>(accepted[i].measurement.z.size()));
  return used;
}

std::optional<LandmarkId> EkfSlam::addLandmark(const Measurement& measurement) {
  const bool is_line = measurement.kind == LandmarkKind::kFloorEdge;
  if (!isUsable(measurement) || !measurement.hasRange()) {
    health_.refuse("measurement not finite");
    return std::nullopt;
  }
  const FreedMeasurement freed = freedOf(state_, measurement);
  if (!isUsable(freed.measurement)) {
    health_.refuse("range shorter than what the sensor adds");
    return std::nullopt;
  }
  const InverseMeasurement inverse = is_line ? lineFromFloor(pose(), freed.measurement)
                                             : pointFromRange(pose(), freed.measurement);
  SparseJacobian J(inverse.block.size());
  J.add(0, 0, inverse.J_robot);
  if (const Block* sensor = sensorOf(state_, measurement))
    J.add(0, sensor->offset, inverse.J_z * freed.J_errors);
  const LandmarkId id = nextId();
  augment(state_,
          {id, is_line ? BlockKind::kFloorLine : BlockKind::kPoint, measurement.kind, 0, {}},
          inverse.block, J, inverse.J_z * noiseOf(freed.measurement) * inverse.J_z.transpose());
  return id;
}

LandmarkId EkfSlam::addPoseClone() {
  const LandmarkId id = nextId();
  augment(state_, {id, BlockKind::kPoseClone, {}, 0, {}}, pose().vector(),
          SparseJacobian(3).add(0, 0, Eigen::Matrix3d::Identity()), Eigen::Matrix3d::Zero());
  return id;
}

namespace {

struct TwoViews {
  Triangulation triangulation;
  SparseJacobian J_state;
  Eigen::Matrix4d bearing_covariance;
};

TwoViews lookTwice(const State& state, const Block& clone, const Measurement& first,
                   const Measurement& now) {
  const Eigen::Vector3d a = state.x.segment<3>(clone.offset);
  const FreedMeasurement bearing_a = freedOf(state, first), bearing_b = freedOf(state, now);
  TwoViews views;
  views.triangulation = triangulate({a(0), a(1), a(2)}, bearing_a.measurement,
                                    state.T_world_robot(), bearing_b.measurement);
  const auto& t = views.triangulation;
  views.J_state.rows = 4;
  views.J_state.add(0, clone.offset, t.J_robot_a).add(0, 0, t.J_robot_b);
  if (const Block* sensor = sensorOf(state, now))
    views.J_state.add(
        0, sensor->offset,
        t.J_bearing_a * bearing_a.J_errors.row(0) + t.J_bearing_b * bearing_b.J_errors.row(0));
  views.bearing_covariance =
      bearing_a.measurement.R(0, 0) * t.J_bearing_a * t.J_bearing_a.transpose() +
      bearing_b.measurement.R(0, 0) * t.J_bearing_b * t.J_bearing_b.transpose();
  return views;
}

}  // namespace

std::optional<EkfSlam::Parallax> EkfSlam::parallax(LandmarkId clone, const Measurement& first,
                                                   const Measurement& now) const {
  const Block* block = state_.find(clone);
  if (!block || !isUsable(first) || !isUsable(now)) return std::nullopt;
  const TwoViews views = lookTwice(state_, *block, first, now);
  const auto& t = views.triangulation;
  if (!t.block.allFinite()) return std::nullopt;
  const Eigen::Matrix4d P = bothSides(views.J_state, state_.P) + views.bearing_covariance;
  return Parallax{t.baseline_m, t.parallax, t.block(3), std::sqrt(std::max(0.0, P(3, 3)))};
}

std::optional<LandmarkId> EkfSlam::addLandmark(LandmarkId clone, const Measurement& first,
                                               const Measurement& now) {
  const auto seen = parallax(clone, first, now);
  if (!seen || seen->inverse_depth <= 0.0) return std::nullopt;
  const TwoViews views = lookTwice(state_, *state_.find(clone), first, now);
  // In front of the first camera; it must lie in front of the present one too.
  Measurement bearing = now;
  bearing.z =
      predictMeasurement(pose(), BlockKind::kInverseDepth, views.triangulation.block, now).z;
  if (std::abs(innovationOf(now, bearing.z)(0)) > kPi / 2.0) return std::nullopt;
  const LandmarkId id = nextId();
  augment(state_, {id, BlockKind::kInverseDepth, now.kind, 0, {}}, views.triangulation.block,
          views.J_state, views.bearing_covariance);
  return id;
}

Evidence& EkfSlam::evidence(LandmarkId landmark) {
  Block* block = state_.find(landmark);
  return (block ? block : resting_.find(landmark))->evidence;
}

void EkfSlam::remove(LandmarkId block) {
  if (isResting(block)) resting_.remove(block);
  const Block* found = state_.find(block);
  if (!found) return;
  if (isFixed(block)) fixed_ -= found->size();
  removeBlock(state_, block);
}

EkfSlam::EkfSlam(const FilterOptions& options, State state)
    : options_(options),
      state_(std::move(state)),
      next_id_(state_.blocks.empty() ? 0 : number(state_.blocks.back().id) + 1) {}

void EkfSlam::placeRobot(const Pose2& T_world_robot, const Eigen::Matrix3d& covariance) {
  state_.x.head<3>() = T_world_robot.vector();
  state_.P.topRows<3>().setZero();
  state_.P.leftCols<3>().setZero();
  state_.P.topLeftCorner<3, 3>() = covariance;
}

void EkfSlam::addSensor(const SensorErrors& sigmas) {
  const LandmarkId id = nextId();
  augment(state_, {id, BlockKind::kSensor, {}, 0, {}}, SensorErrors{}.vector(),
          SparseJacobian(SensorErrors::kSize),
          sigmas.vector().cwiseAbs2().asDiagonal().toDenseMatrix());
  state_.sensor = id;
}

std::optional<SensorEstimate> EkfSlam::sensor() const {
  if (!state_.sensor) return std::nullopt;
  const Block& block = *state_.find(*state_.sensor);
  return SensorEstimate{
      errorsOf(state_, &block),
      state_.P.block<SensorErrors::kSize, SensorErrors::kSize>(block.offset, block.offset)};
}

bool EkfSlam::isFixed(LandmarkId block) const {
  const Block* found = state_.find(block);
  return found && found->offset - 3 < fixed_;
}

Eigen::MatrixXd EkfSlam::covarianceOf(const SparseJacobian& H) const {
  return bothSides(H, state_.P);
}

bool EkfSlam::constrain(const SparseJacobian& H, const Eigen::VectorXd& nu,
                        const Eigen::MatrixXd& R) {
  if (!nu.allFinite() || !R.allFinite()) return false;
  return correct(state_, H, nu, R, options_.invariant, fixed_);
}

std::vector<LandmarkId> EkfSlam::settleInverseDepths() {
  std::vector<LandmarkId> settled;
  for (const Block& block : state_.blocks) {
    if (block.block_kind != BlockKind::kInverseDepth || isFixed(block.id)) continue;
    const BlockVector y = state_.values(block);
    const double rho = y(3);
    const double rho_sigma = std::sqrt(state_.P(block.offset + 3, block.offset + 3));
    if (rho <= 3.0 * rho_sigma) continue;
    // Civera, Davison and Montiel 2008, eq. 35: L = 4 sigma_d / d |cos a|, a the parallax between
    // the anchor's ray and the present one, d the present distance.
    const Eigen::Vector2d point = pointOf(y);
    const Eigen::Vector2d from_anchor = point - y.head<2>();
    const Eigen::Vector2d from_robot = point - pose().translation();
    const double distance_sigma = rho_sigma / (rho * rho);
    const double cosine = from_anchor.dot(from_robot) / (from_anchor.norm() * from_robot.norm());
    const double linearity = 4.0 * distance_sigma / from_robot.norm() * std::abs(cosine);
    if (linearity < options_.inverse_depth_linearity) settled.push_back(block.id);
  }
  for (const LandmarkId id : settled) {
    Eigen::Matrix<double, 2, 4> J;
    const Eigen::Vector2d point = pointOf(state_.values(*state_.find(id)), &J);
    replaceBlock(state_, id, BlockKind::kPoint, point, J);
  }
  return settled;
}

LandmarkId EkfSlam::addAxis(double direction, double sigma) {
  const LandmarkId id = nextId();
  BlockVector angle(1);
  angle << wrapAngle(pose().phi + direction);
  augment(state_, {id, BlockKind::kAxis, {}, 0, {}}, angle,
          SparseJacobian(1).add(0, 2, Eigen::MatrixXd::Ones(1, 1)),
          Eigen::MatrixXd::Constant(1, 1, sigma * sigma));
  return id;
}

namespace {

SparseJacobian axisJacobian(const Block& axis, const PredictedAxis& predicted) {
  SparseJacobian H(1);
  H.add(0, 2, Eigen::MatrixXd::Constant(1, 1, predicted.H_phi));
  H.add(0, axis.offset, Eigen::MatrixXd::Constant(1, 1, predicted.H_axis));
  return H;
}

}  // namespace

std::optional<Innovation> EkfSlam::axisInnovation(LandmarkId axis, double direction,
                                                  double sigma) const {
  const Block* block = state_.find(axis);
  if (!block || !std::isfinite(direction) || !std::isfinite(sigma)) return std::nullopt;
  const auto predicted = predictAxis(pose(), state_.x(block->offset));
  const SparseJacobian H = axisJacobian(*block, predicted);
  const double S = bothSides(H, state_.P)(0, 0) + sigma * sigma;
  if (!(S > 0.0)) return std::nullopt;
  Innovation innovation;
  innovation.nu.resize(1);
  innovation.nu << wrapQuarterTurn(direction - predicted.direction);
  innovation.S.resize(1, 1);
  innovation.S << S;
  innovation.distance2 = innovation.nu(0) * innovation.nu(0) / S;
  innovation.within_gate = innovation.distance2 <= chiSquareQuantile(options_.gate_probability, 1);
  return innovation;
}

bool EkfSlam::updateAxis(LandmarkId axis, double direction, double sigma, double noise_scale) {
  const auto expected = axisInnovation(axis, direction, sigma);
  if (!expected || !expected->within_gate) {
    health_.refuse("outside the gate: axis");
    return false;
  }
  const Block& block = *state_.find(axis);
  const SparseJacobian H = axisJacobian(block, predictAxis(pose(), state_.x(block.offset)));
  return correct(state_, H, expected->nu,
                 Eigen::MatrixXd::Constant(1, 1, noise_scale * sigma * sigma), options_.invariant,
                 fixed_);
}

}  // namespace colonnade
