// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "rows_of_set.hpp"

namespace colonnade {
namespace {

/// For each pairing of a set the logarithm of its density given the rest, over that of clutter.
/// With Q = S^-1 and v = Q nu the innovation given the rest is Q_ii^-1 v_i, its covariance Q_ii^-1.
/// Empty when S is singular.
std::vector<double> scores(const JointPairings& joint, const std::vector<std::size_t>& set) {
  const auto rows = rowsOf(joint, set);
  const Eigen::LLT<Eigen::MatrixXd> llt(joint.S(rows, rows));
  if (llt.info() != Eigen::Success) return {};
  const Eigen::MatrixXd Q = llt.solve(Eigen::MatrixXd::Identity(llt.rows(), llt.rows()));
  const Eigen::VectorXd v = Q * joint.nu(rows);
  std::vector<double> scores;
  Eigen::Index row = 0;
  for (const std::size_t i : set) {
    const Eigen::Index size = joint.size[i];
    const MeasurementCovariance Q_i = Q.block(row, row, size, size);
    const MeasurementVector v_i = v.segment(row, size);
    const double distance2 = v_i.dot(Q_i.ldlt().solve(v_i));
    const double log_density = 0.5 * (std::log(Q_i.determinant()) - distance2 -
                                      static_cast<double>(size) * std::log(2.0 * kPi));
    const double score = log_density - joint.pairings[i].log_clutter;
    scores.push_back(std::isnan(score) ? -HUGE_VAL : score);
    row += size;
  }
  return scores;
}

}  // namespace

std::vector<std::size_t> likelierThanClutter(const JointPairings& joint,
                                             std::vector<std::size_t> set) {
  while (!set.empty()) {
    const std::vector<double> all = scores(joint, set);
    const auto worst = std::min_element(all.begin(), all.end());
    if (worst == all.end() || *worst >= 0.0) break;
    set.erase(set.begin() + (worst - all.begin()));
  }
  return set;
}

}  // namespace colonnade
