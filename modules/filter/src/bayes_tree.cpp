// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/bayes_tree.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

namespace colonnade {
namespace {

/// J^T J of a factor of three variables and its right side without an allocation.
using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 16, 16>;

}  // namespace

int BayesTree::addVariable(int size) {
  Node node;
  node.size = size;
  node.at = static_cast<Eigen::Index>(x_.size());
  nodes_.push_back(std::move(node));
  x_.resize(x_.size() + index(size), 0.0);
  position_.push_back(-1);
  row_.push_back(-1);
  return static_cast<int>(nodes_.size()) - 1;
}

int BayesTree::addFactor(LinearFactor factor) {
  const int number = static_cast<int>(factors_.size());
  fresh_.push_back(number);
  listed_.push_back(true);
  touch(factor);
  factors_.push_back(std::move(factor));
  return number;
}

void BayesTree::setFactor(int factor, LinearFactor to) {
  LinearFactor& here = factors_[index(factor)];
  touch(here);
  if (!to.variables.empty() && !listed_[index(factor)]) {
    fresh_.push_back(factor);
    listed_[index(factor)] = true;
  }
  touch(to);
  here = std::move(to);
}

void BayesTree::touch(const LinearFactor& factor) {
  touched_.insert(touched_.end(), factor.variables.begin(), factor.variables.end());
}

bool BayesTree::update(std::span<const int> last) {
  roots_.assign(last.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(last.size(), 2)),
                last.end());
  touched_.insert(touched_.end(), roots_.begin(), roots_.end());
  const std::vector<int> orphans = takeTop();
  putInOrder(orphans, last);
  assign(orphans);
  bool good = true;
  work_ = 0.0;
  for (const int v : order_) good = good && eliminate(v);
  if (good)
    ++solution_;
  else
    touched_ = order_;
  for (const int v : order_) position_[index(v)] = -1;
  return good;
}

/// Takes what was touched and all above it out of the tree, into order_, and its factors into
/// free_; what is left below.
std::vector<int> BayesTree::takeTop() {
  order_.clear();
  for (int v : std::exchange(touched_, {}))
    for (; v >= 0 && position_[index(v)] < 0; v = node(v).parent) {
      position_[index(v)] = 0;
      order_.push_back(v);
    }
  std::vector<int> orphans;
  free_ = std::exchange(fresh_, {});
  for (const int v : order_) {
    Node& gone = node(v);
    free_.insert(free_.end(), gone.factors.begin(), gone.factors.end());
    gone.factors.clear();
    for (const int child : gone.children)
      if (position_[index(child)] < 0) orphans.push_back(child);
    gone.children.clear();
    gone.separator.clear();
    gone.parent = -1;
    gone.done = false;
  }
  std::erase_if(free_, [&](int f) {
    listed_[index(f)] = !factors_[index(f)].variables.empty();
    return !listed_[index(f)];
  });
  return orphans;
}

void BayesTree::putInOrder(const std::vector<int>& orphans, std::span<const int> last) {
  const auto size = static_cast<Eigen::Index>(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) position_[index(order_[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> together;
  const auto hangTogether = [&](const std::vector<int>& variables) {
    for (const int v : variables)
      for (const int u : variables)
        together.emplace_back(position_[index(v)], position_[index(u)], 1.0);
  };
  for (const int f : free_) hangTogether(factors_[index(f)].variables);
  for (const int orphan : orphans) hangTogether(node(orphan).separator);
  Eigen::SparseMatrix<double> graph(size, size);
  graph.setFromTriplets(together.begin(), together.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  if (size > 0) Eigen::AMDOrdering<int>()(graph, permutation);
  std::vector<bool> is_last(order_.size(), false);
  for (const int v : last)
    if (position_[index(v)] >= 0) is_last[index(position_[index(v)])] = true;
  std::vector<int> order;
  for (Eigen::Index i = 0; i < size; ++i)
    if (const auto k = index(permutation.indices()(i)); !is_last[k]) order.push_back(order_[k]);
  for (const int v : last)
    if (position_[index(v)] >= 0) order.push_back(v);
  order_ = std::move(order);
  for (std::size_t i = 0; i < order_.size(); ++i) position_[index(order_[i])] = static_cast<int>(i);
}

int BayesTree::firstPosition(const std::vector<int>& variables) const {
  int first = position_[index(variables.front())];
  for (const int v : variables) first = std::min(first, position_[index(v)]);
  return first;
}

/// Each factor and each part that stays eliminated counts where the first of its variables is.
void BayesTree::assign(const std::vector<int>& orphans) {
  for (const int f : free_)
    node(order_[index(firstPosition(factors_[index(f)].variables))]).factors.push_back(f);
  for (const int orphan : orphans) {
    const int first = order_[index(firstPosition(node(orphan).separator))];
    node(orphan).parent = first;
    node(first).children.push_back(orphan);
  }
}

void BayesTree::findRows(const std::vector<int>& variables) {
  at_.clear();
  for (const int v : variables)
    for (int i = 0; i < node(v).size; ++i) at_.push_back(row_[index(v)] + i);
}

bool BayesTree::eliminate(int variable) {
  Node& here = node(variable);
  std::vector<int>& separator = here.separator;
  row_[index(variable)] = 0;
  const auto take = [&](const std::vector<int>& variables) {
    for (const int v : variables) {
      if (row_[index(v)] >= 0) continue;
      row_[index(v)] = 0;
      separator.push_back(v);
    }
  };
  for (const int f : here.factors) take(factors_[index(f)].variables);
  for (const int child : here.children) take(node(child).separator);
  std::sort(separator.begin(), separator.end(),
            [&](int a, int b) { return position_[index(a)] < position_[index(b)]; });
  Eigen::Index rows = here.size;
  for (const int v : separator) {
    row_[index(v)] = rows;
    rows += node(v).size;
  }

  // The front: its columns of the variable, and below them its lower triangle of the separator.
  const Eigen::Index size = here.size, rest = rows - size;
  Eigen::MatrixXd &L = here.L, &S = here.S;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  L.setZero(rows, size);
  S.resize(rest, rest);
  for (Eigen::Index j = 0; j < rest; ++j) S.col(j).tail(rest - j).setZero();
  const auto entry = [&](Eigen::Index row, Eigen::Index column) -> double& {
    return column < size ? L(row, column) : S(row - size, column - size);
  };
  for (const int f : here.factors) {
    const LinearFactor& factor = factors_[index(f)];
    findRows(factor.variables);
    const Gram G = factor.J_r.transpose().lazyProduct(factor.J_r);
    const Eigen::Index n = G.rows() - 1;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index column = at_[static_cast<std::size_t>(j)];
      b(column) -= G(j, n);
      for (Eigen::Index i = 0; i < n; ++i)
        if (const Eigen::Index row = at_[static_cast<std::size_t>(i)]; row >= column)
          entry(row, column) += G(i, j);
    }
  }
  for (const int child : here.children) {
    const Node& below = node(child);
    findRows(below.separator);
    const auto n = static_cast<Eigen::Index>(at_.size());
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index column = at_[static_cast<std::size_t>(j)];
      b(column) += below.s(j);
      for (Eigen::Index i = j; i < n; ++i) {
        const Eigen::Index row = at_[static_cast<std::size_t>(i)];
        entry(std::max(row, column), std::min(row, column)) += below.S(i, j);
      }
    }
  }
  row_[index(variable)] = -1;
  for (const int v : separator) row_[index(v)] = -1;

  const Eigen::LLT<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>> llt(
      L.topRows(size));
  if (llt.info() != Eigen::Success || !L.allFinite() || !b.allFinite()) return false;
  L.topRows(size) = llt.matrixL();
  const auto corner = L.topRows(size).triangularView<Eigen::Lower>();
  here.y = b.head(size);
  corner.solveInPlace(here.y);
  auto below = L.bottomRows(rest);
  corner.transpose().solveInPlace<Eigen::OnTheRight>(below);
  S.selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  here.s = b.tail(rest) - below * here.y;
  work_ += static_cast<double>(S.size());
  here.done = true;
  if (!separator.empty()) {
    here.parent = separator.front();
    node(here.parent).children.push_back(variable);
  }
  return true;
}

Eigen::Map<const Eigen::VectorXd> BayesTree::x(int variable) {
  asked_.clear();
  for (int v = variable; v >= 0 && node(v).done && node(v).solved != solution_; v = node(v).parent)
    asked_.push_back(v);
  for (auto v = asked_.rbegin(); v != asked_.rend(); ++v) solve(node(*v));
  return {x_.data() + node(variable).at, node(variable).size};
}

void BayesTree::solve(Node& here) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1> x = here.y;
  Eigen::Index row = here.size;
  for (const int v : here.separator) {
    const Node& above = node(v);
    const Eigen::Map<const Eigen::VectorXd> x_above(x_.data() + above.at, above.size);
    x -= here.L.middleRows(row, above.size).transpose().lazyProduct(x_above);
    row += above.size;
  }
  here.L.topRows(here.size).triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  std::copy(x.begin(), x.end(), x_.begin() + here.at);
  here.solved = solution_;
}

Eigen::MatrixXd BayesTree::covarianceOfLast() const {
  Eigen::Index rows = 0;
  for (const int v : roots_) rows += nodes_[index(v)].size;
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::Index at = 0;
  for (const int v : roots_) {
    const Node& root = nodes_[index(v)];
    L.block(at, at, root.L.rows(), root.size) = root.L;
    at += root.size;
  }
  return (L * L.transpose()).inverse();
}

}  // namespace colonnade
