// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "settle.hpp"

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
/// A step that gains less, of the cost and in all, ends the search, unless it was held back.
constexpr double kConverged = 1e-6, kNothing = 1e-9;
constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-10, kMostDamping = 1e9;
constexpr double kHeldBack = 1e-2;
/// An unused sighting costs no more than one at the gate of this probability.
constexpr double kDearest = 0.999999;
/// What damping 1 holds xi and a point to, m and rad. Damping by the diagonal of H would weigh the
/// stiffness of the motions, which resist no turn of a long stretch.
constexpr double kDampedSigma = 0.1;
/// Trials of other drives: so many poses and sightings in all steps together; points known
/// beforehand, which all hang together, take as long as their square.
constexpr std::size_t kMostTried = 1'000'000;

using Sparse = Eigen::SparseMatrix<double>;

/// What is sought, without what was measured.
class Estimate {
 public:
  explicit Estimate(const Drive& drive)
      : T_world_robot_(drive.T_world_robot),
        points_world_(drive.points_world),
        sensor_(drive.sensor) {}
  void putBack(Drive& drive) const {
    drive.T_world_robot = T_world_robot_;
    drive.points_world = points_world_;
    drive.sensor = sensor_;
  }

 private:
  std::vector<Pose2> T_world_robot_;
  std::vector<Eigen::Vector2d> points_world_;
  std::optional<Drive::Sensor> sensor_;
};

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
    const Estimate former(drive);
    move(drive, here, factor.solve(-here.g()));
    NormalEquations there(drive);
    const double gained = here.cost() - there.cost();
    if (!(gained >= -kNothing)) {  // less is rounding
      former.putBack(drive);
      damping *= 10.0;
      continue;
    }
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

}  // namespace

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
    result.cost += costOfUnused(sighting.measurement.z.size(), probability);
  }
}

double costOfUnused(Eigen::Index size, double probability) {
  return huberLoss(chiSquareQuantile(std::min(probability, kDearest), static_cast<int>(size)),
                   size);
}

int affordableSteps(const Drive& drive) {
  const std::size_t known = drive.prior ? drive.prior->points_world.size() : 0;
  return static_cast<int>(
      1 + kMostTried / (drive.T_world_robot.size() + drive.sightings.size() + known * known));
}

}  // namespace colonnade
