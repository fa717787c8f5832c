// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/smoother.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "colonnade/filter/gate.hpp"
#include "duplicates.hpp"
#include "normal_equations.hpp"
#include "settle.hpp"

namespace colonnade {
namespace {

/// A mended stretch that gains less, of the cost, stays as it was.
constexpr double kNoGain = 1e-6;
/// Two solutions for each point: of more points they take longer than the smoothing.
constexpr std::size_t kMostCovariances = 500;

using Sparse = Eigen::SparseMatrix<double>;

/// The drive with the poses from `first` to before `last` moving on as measured from the pose
/// before, without their sightings; points nothing else saw come along.
Drive withoutSightings(const Drive& drive, std::size_t first, std::size_t last) {
  Drive other = drive;
  const Pose2 shift = drive.T_world_robot[first - 1] * drive.motions[first].T_previous_robot *
                      drive.T_world_robot[first].inverse();
  for (std::size_t k = first; k < last; ++k)
    other.T_world_robot[k] = shift * drive.T_world_robot[k];
  std::vector<bool> elsewhere(drive.points_world.size(), false);  // or known beforehand
  if (drive.prior) std::fill_n(elsewhere.begin(), drive.prior->points_world.size(), true);
  for (Drive::Sighting& sighting : other.sightings) {
    const bool within = sighting.pose >= first && sighting.pose < last;
    elsewhere[sighting.point] = elsewhere[sighting.point] || (!within && sighting.used);
    sighting.used = sighting.used && !within;
  }
  for (std::size_t i = 0; i < elsewhere.size(); ++i)
    if (!elsewhere[i]) other.points_world[i] = transform(shift, drive.points_world[i]);
  return other;
}

/// A stretch between two motions that are far from what was measured has been bent to suit its
/// sightings: each such stretch is tried without them and left so where that is cheaper.
void mend(Drive& drive, double probability, Smoothing& result) {
  std::vector<std::size_t> torn;
  for (std::size_t k = 1; k < drive.T_world_robot.size(); ++k)
    if (motionDistance2(drive, k) > chiSquareQuantile(probability, 3)) torn.push_back(k);
  const int most_steps = result.steps + affordableSteps(drive);
  for (std::size_t i = 0; i + 1 < torn.size() && result.steps < most_steps; ++i) {
    Drive other = withoutSightings(drive, torn[i], torn[i + 1]);
    Smoothing how = result;
    settle(other, probability, how);
    const bool cheaper = how.cost < result.cost * (1.0 - kNoGain);
    result.steps = how.steps;
    if (!cheaper) continue;
    drive = std::move(other);
    result = how;
  }
}

/// Of `size` entries of dx, from `first` on.
Eigen::MatrixXd covarianceOf(const Eigen::SimplicialLDLT<Sparse>& factor, Eigen::Index first,
                             Eigen::Index size) {
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    covariance.col(i) =
        factor.solve(Eigen::VectorXd::Unit(factor.rows(), first + i)).segment(first, size);
  return 0.5 * (covariance + covariance.transpose());
}

Eigen::MatrixXd pointCovariance(const Drive& drive) {
  const NormalEquations at(drive);
  const Eigen::SimplicialLDLT<Sparse> factor(at.H());
  if (factor.info() != Eigen::Success) return {};
  return covarianceOf(factor, at.pointAt(0), at.sensorAt() - at.pointAt(0));
}

Smoothing smoothWithoutCovariance(Drive& drive, double gate_probability) {
  Smoothing result;
  for (Drive::Sighting& sighting : drive.sightings)
    sighting.used = sighting.used && std::isfinite(distance2(drive, sighting));
  if (drive.T_world_robot.size() < 2 || drive.sightings.empty()) return result;
  settle(drive, gate_probability, result);
  mend(drive, gate_probability, result);
  mergeDuplicates(drive, gate_probability, result);
  return result;
}

}  // namespace

Smoothing smooth(Drive& drive, double gate_probability) {
  Smoothing result = smoothWithoutCovariance(drive, gate_probability);
  if (result.steps == 0) return result;
  if (drive.points_world.size() <= kMostCovariances) result.covariance = pointCovariance(drive);
  return result;
}

double smoothedCost(Drive drive, double gate_probability) {
  return smoothWithoutCovariance(drive, gate_probability).cost;
}

std::optional<SensorFit> sensorFit(const Drive& drive, const SensorErrors& sigmas) {
  Drive with = drive;
  if (!with.sensor) with.sensor = {{}, sigmas};
  const NormalEquations at(with);
  const Eigen::SimplicialLDLT<Sparse> factor(at.H());
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd dx = factor.solve(-at.g());
  SensorFit fit;
  fit.estimate.errors = SensorErrors::of(with.sensor->errors.vector() +
                                         dx.segment<SensorErrors::kSize>(at.sensorAt()));
  fit.estimate.covariance = covarianceOf(factor, at.sensorAt(), SensorErrors::kSize);
  fit.gain = -at.g().dot(dx);  // about here the cost is g dx 2 + dx H dx more
  return fit;
}

}  // namespace colonnade
