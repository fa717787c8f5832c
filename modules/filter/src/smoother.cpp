// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/smoother.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

#include "colonnade/filter/gate.hpp"
#include "normal_equations.hpp"

namespace colonnade {
namespace {

constexpr int kMostSteps = 100;
constexpr int kMostGatings = 5;
constexpr int kMostMendings = 20;
/// Of the cost: less gained in a step ends the search.
constexpr double kConverged = 1e-6;
constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-10, kMostDamping = 1e9;
/// What damping 1 holds a pose and a point to, m and rad. Damping by the diagonal of H would weigh
/// the stiffness of the motions, which resist no turn of a long stretch.
constexpr double kDampedSigma = 0.1;
/// Two solutions for each point: of more points they take longer than the smoothing.
constexpr std::size_t kMostCovariances = 500;

using Sparse = Eigen::SparseMatrix<double>;

/// Downhill, with Levenberg's damping (Quarterly of Applied Mathematics 2, 1944): it grows where a
/// step does not help.
void descend(Drive& drive, Smoothing& result) {
  NormalEquations here(drive);
  Sparse H = here.H();
  Eigen::SimplicialLDLT<Sparse> factor;
  factor.analyzePattern(H);
  double damping = kFirstDamping;
  result.converged = false;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    ++result.steps;
    Sparse damped = H;
    damped.diagonal().array() += damping / (kDampedSigma * kDampedSigma);
    factor.factorize(damped);
    const Eigen::VectorXd dx = factor.solve(-here.g());
    Drive moved = drive;
    move(moved, here, dx);
    NormalEquations there(moved);
    const double gained = here.cost() - there.cost();
    if (factor.info() != Eigen::Success || !(gained >= 0.0)) {
      damping *= 10.0;
      continue;
    }
    drive = std::move(moved);
    here = std::move(there);
    H = here.H();
    damping = std::max(0.1 * damping, kLeastDamping);
    result.converged = gained <= kConverged * here.cost();
    if (result.converged) break;
  }
  result.cost = here.cost();
}

double boundOf(const Drive::Sighting& sighting, double probability) {
  return chiSquareQuantile(probability, static_cast<int>(sighting.measurement.z.size()));
}

/// Whether any sighting came in or went out.
bool gate(Drive& drive, double probability) {
  bool changed = false;
  for (Drive::Sighting& sighting : drive.sightings) {
    const bool within = distance2(drive, sighting) <= boundOf(sighting, probability);
    changed = changed || within != sighting.used;
    sighting.used = within;
  }
  return changed;
}

/// Descends with the sightings within the gate; each of the others costs what the gate allows.
void settle(Drive& drive, double probability, Smoothing& result) {
  for (int gating = 0; gating < kMostGatings; ++gating) {
    descend(drive, result);
    if (!gate(drive, probability)) break;
  }
  result.unused = 0;
  for (const Drive::Sighting& sighting : drive.sightings) {
    if (sighting.used) continue;
    ++result.unused;
    result.cost += boundOf(sighting, probability);
  }
}

/// A stretch between two motions that are far from what was measured has been bent to suit its
/// sightings: each such stretch is tried without them, moving on as measured from the pose before.
/// Whether that made one cheaper.
bool mend(Drive& drive, double probability, Smoothing& result) {
  std::vector<std::size_t> torn;
  for (std::size_t k = 1; k < drive.T_world_robot.size(); ++k)
    if (motionDistance2(drive, k) > chiSquareQuantile(probability, 3)) torn.push_back(k);
  for (std::size_t i = 0; i + 1 < torn.size(); ++i) {
    Drive other = drive;
    const Pose2 shift = drive.T_world_robot[torn[i] - 1] * drive.motions[torn[i]].T_previous_robot *
                        drive.T_world_robot[torn[i]].inverse();
    for (std::size_t k = torn[i]; k < torn[i + 1]; ++k)
      other.T_world_robot[k] = shift * drive.T_world_robot[k];
    for (Drive::Sighting& sighting : other.sightings)
      if (sighting.pose >= torn[i] && sighting.pose < torn[i + 1]) sighting.used = false;
    Smoothing how = result;
    settle(other, probability, how);
    if (how.cost >= result.cost * (1.0 - kConverged)) continue;
    drive = std::move(other);
    result = how;
    return true;
  }
  return false;
}

std::vector<Eigen::Matrix2d> pointCovariances(const Drive& drive) {
  const NormalEquations at(drive);
  const Sparse H = at.H();
  const Eigen::SimplicialLDLT<Sparse> factor(H);
  std::vector<Eigen::Matrix2d> covariances(drive.points_world.size());
  for (std::size_t i = 0; i < covariances.size(); ++i)
    for (Eigen::Index k = 0; k < 2; ++k)
      covariances[i].col(k) = factor.solve(Eigen::VectorXd::Unit(H.rows(), at.pointAt(i) + k))
                                  .segment<2>(at.pointAt(i));
  return covariances;
}

}  // namespace

Smoothing smooth(Drive& drive, double gate_probability) {
  Smoothing result;
  if (drive.sightings.empty()) return result;
  settle(drive, gate_probability, result);
  for (int mending = 0; mending < kMostMendings; ++mending)
    if (!mend(drive, gate_probability, result)) break;
  if (drive.points_world.size() <= kMostCovariances)
    result.point_covariances = pointCovariances(drive);
  return result;
}

}  // namespace colonnade
