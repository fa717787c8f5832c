// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/filter/gate.hpp"
#include "rows_of_set.hpp"

namespace colonnade {
namespace {

/// Of the right matches, those that count as supporters of a right single match: few enough to
/// tell right from wrong, since the rest join later.
constexpr double kSupport = 0.9;

/// The squared distance of every pairing once the state is corrected by the pairings `by`: of nu_i
/// - S_ib S_bb^-1 nu_b with covariance S_ii - S_ib S_bb^-1 S_bi. Empty when S_bb is singular.
std::vector<double> distancesGiven(const JointPairings& joint, const std::vector<std::size_t>& by) {
  const auto rows = rowsOf(joint, by);
  const Eigen::MatrixXd S_by = joint.S(rows, rows);
  const Eigen::LLT<Eigen::MatrixXd> llt(S_by);
  if (llt.info() != Eigen::Success) return {};
  const Eigen::MatrixXd cross = joint.S(rows, Eigen::all);
  const Eigen::MatrixXd whitened = llt.matrixL().solve(cross);
  const Eigen::VectorXd nu_by = joint.nu(rows);
  const Eigen::VectorXd nu = joint.nu - whitened.transpose() * llt.matrixL().solve(nu_by);
  std::vector<double> distances;
  for (std::size_t i = 0; i < joint.pairings.size(); ++i) {
    const auto known = whitened.middleCols(joint.first[i], joint.size[i]);
    const MeasurementCovariance S =
        joint.S.block(joint.first[i], joint.first[i], joint.size[i], joint.size[i]) -
        known.transpose() * known;
    const MeasurementVector nu_i = nu.segment(joint.first[i], joint.size[i]);
    const double distance2 = nu_i.dot(S.ldlt().solve(nu_i));
    distances.push_back(std::isfinite(distance2) ? distance2 : HUGE_VAL);
  }
  return distances;
}

/// `set` and what agrees with it: nearest first, each detection and each landmark once.
std::vector<std::size_t> grow(const JointPairings& joint, std::vector<std::size_t> set,
                              double probability) {
  const auto distances = distancesGiven(joint, set);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] <= chiSquareQuantile(probability, static_cast<int>(joint.size[i])))
      order.push_back(i);
  const auto cost = [&](std::size_t i) {  // the looks' part does not change
    return distances[i] + joint.pairings[i].cost - joint.pairings[i].distance2;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  for (const std::size_t i : order) {
    const bool taken = std::any_of(set.begin(), set.end(), [&](std::size_t c) {
      return joint.pairings[c].detection == joint.pairings[i].detection ||
             joint.pairings[c].landmark == joint.pairings[i].landmark;
    });
    if (!taken) set.push_back(i);
  }
  return set;
}

}  // namespace

std::vector<std::size_t> consensusPairings(const JointPairings& joint, double probability) {
  std::vector<std::size_t> best;
  double best_distance2 = HUGE_VAL;
  for (std::size_t single = 0; single < joint.pairings.size(); ++single) {
    auto supporting = grow(joint, {single}, kSupport);
    if (supporting.size() < best.size()) continue;
    const double distance2 = jointDistance2(joint, supporting);
    if (supporting.size() == best.size() && distance2 >= best_distance2) continue;
    best = std::move(supporting);
    best_distance2 = distance2;
  }
  // Once all of these have corrected the state, what still agrees may join: high innovations, of
  // near or young landmarks.
  return grow(joint, std::move(best), probability);
}

}  // namespace colonnade
