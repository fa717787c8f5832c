// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/bayes_tree.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

namespace colonnade {
namespace {

/// The same least squares in a tree and as one dense matrix.
class Both {
 public:
  explicit Both(unsigned seed) : random_(seed) {}

  int addVariable() {
    sizes_.push_back(std::uniform_int_distribution<int>(1, 5)(random_));
    const int v = tree.addVariable(sizes_.back());
    add({v});
    return v;
  }
  void add(std::vector<int> variables) {
    factors_.push_back(random(variables));
    variables_.push_back(variables);
    numbers_.push_back(tree.addFactor(factors_.back()));
  }
  /// Another factor of the same variables, or none.
  void change(std::size_t i, bool none) {
    factors_[i] = none ? LinearFactor{} : random(variables_[i]);
    tree.setFactor(numbers_[i], factors_[i]);
  }
  std::size_t factors() const { return factors_.size(); }
  std::size_t variables() const { return sizes_.size(); }
  int any() {
    return std::uniform_int_distribution<int>(0, static_cast<int>(sizes_.size()) - 1)(random_);
  }
  bool isUnary(std::size_t i) const { return variables_[i].size() == 1; }

  void expectEqual(const std::vector<int>& last) {
    std::vector<Eigen::Index> at{0};
    for (const int size : sizes_) at.push_back(at.back() + size);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(at.back(), at.back());
    Eigen::VectorXd b = Eigen::VectorXd::Zero(at.back());
    for (const LinearFactor& factor : factors_) {
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(factor.J_r.rows(), at.back());
      Eigen::Index column = 0;
      for (const int v : factor.variables) {
        const Eigen::Index size = sizes_[static_cast<std::size_t>(v)];
        J.middleCols(at[static_cast<std::size_t>(v)], size) = factor.J_r.middleCols(column, size);
        column += size;
      }
      if (factor.variables.empty()) continue;
      H += J.transpose() * J;
      b -= J.transpose() * factor.J_r.rightCols<1>();
    }
    const Eigen::VectorXd x = H.llt().solve(b);
    for (std::size_t v = 0; v < sizes_.size(); ++v)
      EXPECT_LT((tree.x(static_cast<int>(v)) - x.segment(at[v], sizes_[v])).norm(), 1e-4) << v;
    std::vector<Eigen::Index> rows;
    for (const int v : last)
      for (Eigen::Index i = at[static_cast<std::size_t>(v)];
           i < at[static_cast<std::size_t>(v) + 1]; ++i)
        rows.push_back(i);
    const Eigen::MatrixXd all = H.inverse();
    const Eigen::MatrixXd P = all(rows, rows);
    EXPECT_LT((tree.covarianceOfLast() - P).norm(), 1e-8 * P.norm());
  }

  BayesTree tree;

 private:
  LinearFactor random(const std::vector<int>& variables) {
    int columns = 1;
    for (const int v : variables) columns += sizes_[static_cast<std::size_t>(v)];
    std::normal_distribution<double> gauss;
    const int rows = variables.size() == 1 ? columns - 1 : 3;
    return {variables, Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return gauss(random_); })};
  }

  std::mt19937 random_;
  std::vector<int> sizes_;
  std::vector<LinearFactor> factors_;
  std::vector<std::vector<int>> variables_;
  std::vector<int> numbers_;
};

TEST(BayesTree, SolvesWhatIsAddedChangedAndTakenAway) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Both both(seed);
    std::mt19937 random(seed);
    const auto oneIn = [&](int n) { return std::uniform_int_distribution<int>(1, n)(random) == 1; };
    both.addVariable();
    for (int round = 0; round < 60; ++round) {
      const auto changed = static_cast<std::size_t>(both.any());
      if (!both.isUnary(changed)) both.change(changed, oneIn(2));
      const int former = both.any();
      const int v = both.addVariable();
      both.add({former, v});
      if (v > 1 && oneIn(3)) both.add({v, (v + 1) / 2, 0});
      const std::vector<int> last{former, v};
      ASSERT_TRUE(both.tree.update(last));
      both.expectEqual(last);
    }
  }
}

TEST(BayesTree, EliminatesOnlyWhatHangsTogetherWithTheChange) {
  BayesTree tree;
  const auto factor = [](std::vector<int> variables, double r) {
    Eigen::MatrixXd J_r(1, static_cast<Eigen::Index>(variables.size()) + 1);
    J_r << Eigen::RowVectorXd::Ones(static_cast<Eigen::Index>(variables.size())), r;
    if (variables.size() == 2) J_r(0) = -1.0;
    return LinearFactor{std::move(variables), J_r};
  };
  int former = tree.addVariable(1);
  tree.addFactor(factor({former}, 0.0));
  for (int k = 1; k < 1000; ++k) {
    const int next = tree.addVariable(1);
    tree.addFactor(factor({former, next}, -1.0));
    ASSERT_TRUE(tree.update(std::vector<int>{next}));
    EXPECT_LE(tree.eliminated(), 4u);
    EXPECT_NEAR(tree.x(next)(0), k, 1e-9 * k);
    former = next;
  }
}

/// Also where one of the two last has nothing to do with what has changed.
TEST(BayesTree, CovariancesAreOfTheTwoThatWereAskedToBeLast) {
  Both both(9);
  const int first = both.addVariable();
  int former = first;
  for (int k = 0; k < 20; ++k) {
    const int next = both.addVariable();
    both.add({former, next});
    const std::vector<int> last{first, next};
    ASSERT_TRUE(both.tree.update(last));
    both.expectEqual(last);
    former = next;
  }
}

TEST(BayesTree, SaysThatEquationsAreSingularAndGoesOnOnceTheyAreNot) {
  BayesTree tree;
  const int a = tree.addVariable(2);
  Eigen::MatrixXd along(1, 3), across(1, 3);
  along << 1.0, 0.0, -3.0;
  across << 0.0, 1.0, 2.0;
  tree.addFactor({{a}, along});
  const std::vector<int> last{a};
  EXPECT_FALSE(tree.update(last));
  tree.addFactor({{a}, across});
  EXPECT_TRUE(tree.update(last));
  EXPECT_LT((tree.x(a) - Eigen::Vector2d(3.0, -2.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace colonnade
