// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "rows_of_set.hpp"

namespace colonnade {

std::vector<std::size_t> nearestPairings(const std::vector<Pairing>& pairings) {
  std::vector<std::size_t> order(pairings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return pairings[a].cost < pairings[b].cost;
  });
  std::set<std::size_t> detections;
  std::set<LandmarkId> landmarks;
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    if (detections.contains(pairings[i].detection) || landmarks.contains(pairings[i].landmark))
      continue;
    detections.insert(pairings[i].detection);
    landmarks.insert(pairings[i].landmark);
    chosen.push_back(i);
  }
  return chosen;
}

std::vector<Eigen::Index> rowsOf(const JointPairings& joint, const std::vector<std::size_t>& set) {
  std::vector<Eigen::Index> rows;
  for (const std::size_t i : set)
    for (Eigen::Index k = 0; k < joint.size[i]; ++k) rows.push_back(joint.first[i] + k);
  return rows;
}

double jointDistance2(const JointPairings& joint, const std::vector<std::size_t>& set) {
  if (set.empty()) return 0.0;
  const auto rows = rowsOf(joint, set);
  const Eigen::MatrixXd S = joint.S(rows, rows);
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) return HUGE_VAL;
  const Eigen::VectorXd nu = joint.nu(rows);
  const double distance2 = nu.dot(llt.solve(nu));
  return std::isfinite(distance2) ? distance2 : HUGE_VAL;
}

int degreesOfFreedom(const JointPairings& joint, const std::vector<std::size_t>& set) {
  Eigen::Index sum = 0;
  for (const std::size_t i : set) sum += joint.size[i];
  return static_cast<int>(sum);
}

}  // namespace colonnade
