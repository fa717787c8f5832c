// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/assignment.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace colonnade {
namespace {

/// Columns of the rows of least total cost; cost has no more rows than columns. Rows enter one by
/// one, each by the shortest augmenting path under the potentials of rows and columns.
std::vector<int> hungarian(const Eigen::MatrixXd& cost) {
  const auto rows = static_cast<int>(cost.rows());
  const auto columns = static_cast<int>(cost.cols());
  std::vector<double> row_potential(static_cast<std::size_t>(rows), 0.0);
  std::vector<double> column_potential(static_cast<std::size_t>(columns), 0.0);
  std::vector<int> row_of(static_cast<std::size_t>(columns), -1);
  const auto u = [](int i) { return static_cast<std::size_t>(i); };
  for (int row = 0; row < rows; ++row) {
    std::vector<double> distance(u(columns), std::numeric_limits<double>::infinity());
    std::vector<int> previous(u(columns), -1);  // the column before on the path
    std::vector<bool> done(u(columns), false);
    int i = row;
    int from = -1;
    double walked = 0.0;
    for (;;) {
      int next = -1;
      for (int j = 0; j < columns; ++j) {
        if (done[u(j)]) continue;
        const double step = walked + cost(i, j) - row_potential[u(i)] - column_potential[u(j)];
        if (step < distance[u(j)]) {
          distance[u(j)] = step;
          previous[u(j)] = from;
        }
        if (next < 0 || distance[u(j)] < distance[u(next)]) next = j;
      }
      walked = distance[u(next)];
      done[u(next)] = true;
      from = next;
      if (row_of[u(next)] < 0) break;
      i = row_of[u(next)];
    }
    row_potential[u(row)] += walked;
    for (int j = 0; j < columns; ++j) {
      if (!done[u(j)] || j == from) continue;
      row_potential[u(row_of[u(j)])] += walked - distance[u(j)];
      column_potential[u(j)] -= walked - distance[u(j)];
    }
    for (int j = from; j >= 0; j = previous[u(j)])
      row_of[u(j)] = previous[u(j)] < 0 ? row : row_of[u(previous[u(j)])];
  }
  std::vector<int> column_of(u(rows), -1);
  for (int j = 0; j < columns; ++j)
    if (row_of[u(j)] >= 0) column_of[u(row_of[u(j)])] = j;
  return column_of;
}

/// Number of the cluster of each estimate (first) and truth (behind them).
class Clusters {
 public:
  explicit Clusters(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

int indexIn(std::vector<std::size_t>& members, std::size_t member) {
  const auto found = std::find(members.begin(), members.end(), member);
  const auto index = static_cast<int>(found - members.begin());
  if (found == members.end()) members.push_back(member);
  return index;
}

}  // namespace

std::vector<std::optional<std::size_t>> assignOneToOne(std::size_t estimates, std::size_t truths,
                                                       const std::vector<Candidate>& candidates,
                                                       double limit) {
  Clusters clusters(estimates + truths);
  for (const auto& c : candidates) clusters.join(c.estimate, estimates + c.truth);
  std::map<std::size_t, std::vector<const Candidate*>> by_cluster;
  for (const auto& c : candidates) by_cluster[clusters.find(c.estimate)].push_back(&c);

  std::vector<std::optional<std::size_t>> result(estimates);
  for (const auto& [cluster, members] : by_cluster) {
    std::vector<std::size_t> rows;
    std::vector<std::size_t> columns;
    std::vector<std::pair<int, int>> places;
    for (const auto* c : members)
      places.emplace_back(indexIn(rows, c->estimate), indexIn(columns, c->truth));
    const auto height = static_cast<Eigen::Index>(rows.size());
    const auto width = static_cast<Eigen::Index>(std::max(rows.size(), columns.size()));
    // What a match saves against leaving both alone; nothing where there is no candidate.
    Eigen::MatrixXd saving = Eigen::MatrixXd::Zero(height, width);
    for (std::size_t i = 0; i < members.size(); ++i) {
      double& entry = saving(places[i].first, places[i].second);
      entry = std::max(entry, limit - members[i]->cost);
    }
    const auto column_of = hungarian(-saving);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int j = column_of[i];
      if (saving(static_cast<Eigen::Index>(i), j) > 0.0)
        result[rows[i]] = columns[static_cast<std::size_t>(j)];
    }
  }
  return result;
}

}  // namespace colonnade
