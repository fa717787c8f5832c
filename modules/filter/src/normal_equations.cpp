// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "normal_equations.hpp"

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// Entries of H from each motion, sighting and point.
constexpr std::size_t kMotionEntries = 36, kSightingEntries = 25, kPointEntries = 2,
                      kSensorEntries = 75;
/// Points that are one thing may be this far apart.
constexpr double kOneSigma_m = 1e-4;

}  // namespace

NormalEquations::NormalEquations(const Drive& drive)
    : held_(drive.prior ? 0 : 1),
      poses_(static_cast<Eigen::Index>(drive.T_world_robot.size())),
      points_(drive.points_world.size()),
      g_(Eigen::VectorXd::Zero(sensorAt() + (drive.sensor ? SensorErrors::kSize : 0))) {
  entries_.reserve(kMotionEntries * drive.motions.size() +
                   (kSightingEntries + (drive.sensor ? kSensorEntries : 0)) *
                       drive.sightings.size() +
                   kPointEntries * drive.points_world.size());
  if (drive.prior) addPrior(drive, *drive.prior);
  for (std::size_t k = 1; k < drive.T_world_robot.size(); ++k) addMotion(drive, k);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) addSighting(drive, sighting);
  if (drive.sensor) addSensor(*drive.sensor);
  for (const Drive::Depth& depth : drive.depths) addDepth(drive, depth);
  for (const Drive::Pair& pair : drive.one) addPairOfOne(drive, pair);
  for (Eigen::Index i = pointAt(0); i < sensorAt(); ++i)
    entries_.emplace_back(i, i, 1.0 / (kLooseSigma_m * kLooseSigma_m));
}

Eigen::SparseMatrix<double> NormalEquations::H() const {
  Eigen::SparseMatrix<double> H(g_.size(), g_.size());
  H.setFromTriplets(entries_.begin(), entries_.end());
  return H;
}

void NormalEquations::addPrior(const Drive& drive, const Drive::Prior& prior) {
  const auto known = static_cast<Eigen::Index>(prior.points_world.size());
  Eigen::Vector3d start = drive.T_world_robot[0].vector() - prior.T_world_start.vector();
  start(2) = wrapAngle(start(2));
  Eigen::VectorXd points(2 * known);
  for (Eigen::Index i = 0; i < known; ++i) {
    const auto point = static_cast<std::size_t>(i);
    points.segment<2>(2 * i) = drive.points_world[point] - prior.points_world[point];
  }
  const Eigen::Matrix3d lift = liftOf(drive.T_world_robot[0]);
  const Eigen::Vector3d pull_start = prior.information_start * start;
  const Eigen::VectorXd pull_points = prior.information_points * points;
  cost_ += start.dot(pull_start) + points.dot(pull_points);
  addBlock(poseAt(0), poseAt(0), lift.transpose() * prior.information_start * lift);
  addBlock(pointAt(0), pointAt(0), prior.information_points);
  g_.segment<3>(poseAt(0)) += lift.transpose() * pull_start;
  g_.segment(pointAt(0), 2 * known) += pull_points;
}

void NormalEquations::addMotion(const Drive& drive, std::size_t pose) {
  const MotionTerm term = motionTerm(drive, pose);
  // Of xi of the pose before it is the same but for the sign.
  const Eigen::Matrix3d J = term.J_after * liftOf(drive.T_world_robot[pose]);
  cost_ += term.residual.dot(term.information * term.residual);
  addPair(poseAt(pose - 1), poseAt(pose), -J, J, term.information, term.residual);
}

void NormalEquations::addDepth(const Drive& drive, const Drive::Depth& depth) {
  const DepthTerm term = depthTerm(drive, depth);
  const Eigen::RowVector3d J_pose = term.J_pose * liftOf(drive.T_world_robot[depth.pose]);
  const Eigen::MatrixXd weight = Eigen::MatrixXd::Constant(1, 1, term.information);
  const Eigen::VectorXd residual = Eigen::VectorXd::Constant(1, term.residual);
  cost_ += residual.dot(weight * residual);
  addPair(poseAt(depth.pose), pointAt(depth.point), J_pose, term.J_point, weight, residual);
}

void NormalEquations::addPairOfOne(const Drive& drive, const Drive::Pair& pair) {
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d weight = I / (kOneSigma_m * kOneSigma_m);
  const Eigen::Vector2d residual = drive.points_world[pair.a] - drive.points_world[pair.b];
  cost_ += residual.dot(weight * residual);
  addPair(pointAt(pair.a), pointAt(pair.b), I, -I, weight, residual);
}

void NormalEquations::addSensor(const Drive::Sensor& sensor) {
  const SensorErrors::Vector information =
      sensor.sigmas.vector().cwiseMax(kKnownSigma).cwiseAbs2().cwiseInverse();
  const SensorErrors::Vector errors = sensor.errors.vector();
  cost_ += errors.cwiseAbs2().dot(information);
  addBlock(sensorAt(), sensorAt(), information.asDiagonal().toDenseMatrix());
  g_.segment<SensorErrors::kSize>(sensorAt()) += information.cwiseProduct(errors);
}

void NormalEquations::addSighting(const Drive& drive, const Drive::Sighting& sighting) {
  const SightingTerm term = sightingTerm(drive, sighting);
  const double distance2 = term.residual.dot(term.information * term.residual);
  cost_ += huberLoss(distance2, term.residual.size());
  const Small weight = huberWeight(distance2, term.residual.size()) * term.information;
  const Small J_pose = term.J_pose * liftOf(drive.T_world_robot[sighting.pose]);
  addPair(poseAt(sighting.pose), pointAt(sighting.point), J_pose, term.J_point, weight,
          term.residual);
  if (!drive.sensor) return;
  const Eigen::MatrixXd weighted = weight * term.J_sensor;
  addBlock(sensorAt(), sensorAt(), term.J_sensor.transpose() * weighted);
  addMixed(poseAt(sighting.pose), sensorAt(), J_pose.transpose() * weighted);
  addMixed(pointAt(sighting.point), sensorAt(), term.J_point.transpose() * weighted);
  g_.segment<SensorErrors::kSize>(sensorAt()) += weighted.transpose() * term.residual;
}

void NormalEquations::addBlock(Eigen::Index row, Eigen::Index column,
                               const Eigen::Ref<const Eigen::MatrixXd>& block) {
  if (row < 0 || column < 0) return;  // the pose that is held
  for (Eigen::Index k = 0; k < block.cols(); ++k)
    for (Eigen::Index i = row == column ? k : 0; i < block.rows(); ++i)
      entries_.emplace_back(row + i, column + k, block(i, k));
}

void NormalEquations::addMixed(Eigen::Index a, Eigen::Index b, const Small& block) {
  if (a > b) return addBlock(a, b, block);
  const Small turned = block.transpose();
  addBlock(b, a, turned);
}

void NormalEquations::addPair(Eigen::Index a, Eigen::Index b, const Small& J_a, const Small& J_b,
                              const Small& weight, const Small& residual) {
  const Small A = J_a.transpose().lazyProduct(weight), B = J_b.transpose().lazyProduct(weight);
  const Small AA = A.lazyProduct(J_a), BB = B.lazyProduct(J_b);
  addBlock(a, a, AA);
  addBlock(b, b, BB);
  addMixed(a, b, A.lazyProduct(J_b));
  if (a >= 0) g_.segment(a, J_a.cols()) += A.lazyProduct(residual).col(0);
  if (b >= 0) g_.segment(b, J_b.cols()) += B.lazyProduct(residual).col(0);
}

Eigen::Matrix3d liftOf(const Pose2& T_world_robot) {
  Eigen::Matrix3d lift = Eigen::Matrix3d::Identity();
  lift.col(2).head<2>() << -T_world_robot.y, T_world_robot.x;
  return lift;
}

void move(Drive& drive, const NormalEquations& at, const Eigen::VectorXd& dx) {
  for (std::size_t k = at.firstFreePose(); k < drive.T_world_robot.size(); ++k)
    drive.T_world_robot[k] = exponential(dx.segment<3>(at.poseAt(k))) * drive.T_world_robot[k];
  for (std::size_t i = 0; i < drive.points_world.size(); ++i)
    drive.points_world[i] += dx.segment<2>(at.pointAt(i));
  if (drive.sensor)
    drive.sensor->errors = SensorErrors::of(drive.sensor->errors.vector() +
                                            dx.segment<SensorErrors::kSize>(at.sensorAt()));
}

}  // namespace colonnade
