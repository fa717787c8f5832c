// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>

#include "colonnade/filter/gate.hpp"
#include "pairing.hpp"

namespace colonnade {
namespace {

/// The Cholesky factor of S of the set under way and its whitened innovation, which grow and shrink
/// by one pairing: |L^-1 nu|^2 is the joint distance.
class GrowingSet {
 public:
  explicit GrowingSet(const JointPairings& joint)
      : joint_(joint), L_(joint.nu.size(), joint.nu.size()), whitened_(joint.nu.size()) {}

  /// False when S would not be positive definite; the set is then as it was.
  bool push(std::size_t pairing) {
    const Eigen::Index rows = static_cast<Eigen::Index>(rows_.size());
    for (Eigen::Index k = 0; k < joint_.size[pairing]; ++k)
      if (!pushRow(joint_.first[pairing] + k)) {
        truncate(rows);
        return false;
      }
    chosen_.push_back(pairing);
    return true;
  }
  void pop() {
    truncate(static_cast<Eigen::Index>(rows_.size()) - joint_.size[chosen_.back()]);
    chosen_.pop_back();
  }
  double distance2() const {
    return whitened_.head(static_cast<Eigen::Index>(rows_.size())).squaredNorm();
  }
  int degreesOfFreedom() const { return static_cast<int>(rows_.size()); }
  const std::vector<std::size_t>& chosen() const { return chosen_; }

 private:
  bool pushRow(Eigen::Index row) {
    const auto n = static_cast<Eigen::Index>(rows_.size());
    double square = joint_.S(row, row);
    double sum = joint_.nu(row);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double l = (joint_.S(row, rows_[static_cast<std::size_t>(j)]) -
                        L_.row(n).head(j).dot(L_.row(j).head(j))) /
                       L_(j, j);
      L_(n, j) = l;
      square -= l * l;
      sum -= l * whitened_(j);
    }
    if (!(square > 0.0)) return false;
    L_(n, n) = std::sqrt(square);
    whitened_(n) = sum / L_(n, n);
    rows_.push_back(row);
    return true;
  }
  void truncate(Eigen::Index rows) { rows_.resize(static_cast<std::size_t>(rows)); }

  const JointPairings& joint_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> L_;
  Eigen::VectorXd whitened_;
  std::vector<Eigen::Index> rows_;
  std::vector<std::size_t> chosen_;
};

/// Depth first over the detections, those with the nearest pairing first: they are the surest, and
/// what comes later must agree with them.
class JointSearch {
 public:
  JointSearch(const JointPairings& joint, double probability, int most_nodes)
      : joint_(joint), probability_(probability), most_nodes_(most_nodes), set_(joint) {
    std::map<std::size_t, std::vector<std::size_t>> of_detection;
    for (std::size_t i = 0; i < joint.pairings.size(); ++i)
      of_detection[joint.pairings[i].detection].push_back(i);
    const auto cost = [&](std::size_t i) { return joint.pairings[i].cost; };
    for (auto& [detection, list] : of_detection) {
      std::stable_sort(list.begin(), list.end(),
                       [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
      levels_.push_back(std::move(list));
    }
    std::stable_sort(levels_.begin(), levels_.end(), [&](const auto& a, const auto& b) {
      return a.size() != b.size() ? a.size() < b.size() : cost(a.front()) < cost(b.front());
    });
    descend(0, 0.0);
  }
  const std::vector<std::size_t>& best() const { return best_; }

 private:
  /// Neither the joint distance nor the looks' part of the cost ever falls when a pairing joins, so
  /// a branch that can only reach the size of the best set must still be cheaper.
  void descend(std::size_t level, double looks) {
    if (++nodes_ > most_nodes_) return;
    const double cost = set_.distance2() + looks;
    const std::size_t reachable = set_.chosen().size() + (levels_.size() - level);
    if (reachable < best_.size() || (reachable == best_.size() && cost >= best_cost_)) return;
    if (level == levels_.size()) {
      best_ = set_.chosen();
      best_cost_ = cost;
      return;
    }
    for (const std::size_t i : levels_[level]) {
      const Pairing& pairing = joint_.pairings[i];
      if (std::any_of(set_.chosen().begin(), set_.chosen().end(), [&](std::size_t c) {
            return joint_.pairings[c].landmark == pairing.landmark;
          }))
        continue;
      if (!set_.push(i)) continue;
      if (set_.distance2() <= chiSquareQuantile(probability_, set_.degreesOfFreedom()))
        descend(level + 1, looks + pairing.cost - pairing.distance2);
      set_.pop();
    }
    descend(level + 1, looks);
  }

  const JointPairings& joint_;
  double probability_;
  int most_nodes_;
  GrowingSet set_;
  std::vector<std::vector<std::size_t>> levels_;  ///< pairings of one detection, cheapest first
  std::vector<std::size_t> best_;
  double best_cost_ = HUGE_VAL;
  int nodes_ = 0;
};

}  // namespace

std::vector<std::size_t> jointPairings(const JointPairings& joint, double probability,
                                       int most_nodes) {
  return JointSearch(joint, probability, most_nodes).best();
}

}  // namespace colonnade
