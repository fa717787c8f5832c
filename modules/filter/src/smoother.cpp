// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/smoother.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "colonnade/filter/gate.hpp"
#include "normal_equations.hpp"

namespace colonnade {
namespace {

constexpr int kMostSteps = 100;
constexpr int kMostGatings = 5;
/// Trials to mend a stretch: so many, and so many poses in all.
constexpr std::size_t kMostTrials = 50, kMostPosesTried = 100'000;
/// A step that gains less, of the cost and in all, ends the search, unless it was held back.
constexpr double kConverged = 1e-6, kNothing = 1e-9;
constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-10, kMostDamping = 1e9;
constexpr double kHeldBack = 1e-2;
/// An unused sighting costs no more than one at the gate of this probability.
constexpr double kDearest = 0.999999;
/// What damping 1 holds xi and a point to, m and rad. Damping by the diagonal of H would weigh the
/// stiffness of the motions, which resist no turn of a long stretch.
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
    if (factor.info() != Eigen::Success) {
      damping *= 10.0;
      continue;
    }
    Drive moved = drive;
    move(moved, here, factor.solve(-here.g()));
    NormalEquations there(moved);
    const double gained = here.cost() - there.cost();
    if (!(gained >= 0.0)) {
      damping *= 10.0;
      continue;
    }
    drive = std::move(moved);
    here = std::move(there);
    H = here.H();
    result.converged =
        gained <= std::max(kConverged * here.cost(), kNothing) && damping < kHeldBack;
    if (result.converged) break;
    damping = std::max(0.1 * damping, kLeastDamping);
  }
  result.cost = here.cost();
}

/// Whether any sighting came in or went out.
bool gate(Drive& drive, double probability) {
  bool changed = false;
  for (Drive::Sighting& sighting : drive.sightings) {
    const auto size = static_cast<int>(sighting.measurement.z.size());
    const double distance = distance2(drive, sighting);
    const bool within = std::isfinite(distance) && distance <= chiSquareQuantile(probability, size);
    changed = changed || within != sighting.used;
    sighting.used = within;
  }
  return changed;
}

/// Descends with the sightings within the gate; each of the others costs as much as one at it.
void settle(Drive& drive, double probability, Smoothing& result) {
  bool settled = false;
  for (int gating = 0; gating < kMostGatings && !settled; ++gating) {
    descend(drive, result);
    if (gating + 1 == kMostGatings) break;
    settled = !gate(drive, probability);
  }
  result.converged = result.converged && settled;
  result.unused = 0;
  for (const Drive::Sighting& sighting : drive.sightings) {
    if (sighting.used) continue;
    ++result.unused;
    const auto size = sighting.measurement.z.size();
    result.cost +=
        huberLoss(chiSquareQuantile(std::min(probability, kDearest), static_cast<int>(size)), size);
  }
}

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
  const std::size_t trials =
      std::min(kMostTrials, 1 + kMostPosesTried / drive.T_world_robot.size());
  for (std::size_t i = 0; i + 1 < torn.size() && i < trials; ++i) {
    Drive other = withoutSightings(drive, torn[i], torn[i + 1]);
    Smoothing how = result;
    settle(other, probability, how);
    const bool cheaper = how.cost < result.cost * (1.0 - kConverged);
    result.steps = how.steps;
    if (!cheaper) continue;
    drive = std::move(other);
    result = how;
  }
}

Eigen::MatrixXd pointCovariance(const Drive& drive) {
  const NormalEquations at(drive);
  const Sparse H = at.H();
  const Eigen::SimplicialLDLT<Sparse> factor(H);
  if (factor.info() != Eigen::Success) return {};
  const Eigen::Index first = at.pointAt(0), size = H.rows() - first;
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    covariance.col(i) = factor.solve(Eigen::VectorXd::Unit(H.rows(), first + i)).tail(size);
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

Smoothing smooth(Drive& drive, double gate_probability) {
  Smoothing result;
  for (Drive::Sighting& sighting : drive.sightings)
    sighting.used = std::isfinite(distance2(drive, sighting));
  if (drive.T_world_robot.size() < 2 || drive.sightings.empty()) return result;
  settle(drive, gate_probability, result);
  mend(drive, gate_probability, result);
  if (drive.points_world.size() <= kMostCovariances) result.covariance = pointCovariance(drive);
  return result;
}

}  // namespace colonnade
