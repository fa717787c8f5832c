// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace colonnade {

/// |J x + r|^2, x what one to three variables of at most five entries have moved by.
struct LinearFactor {
  std::vector<int> variables;
  Eigen::MatrixXd J_r;  ///< the columns of the variables one after another and, last, r
};

/// Linear least squares that change little from one solution to the next: variables are eliminated
/// one after another, and where factors change only those eliminated from there on are eliminated
/// again, in a new order (the Bayes tree of Kaess, Johannsson, Roberts, Ila, Leonard and Dellaert,
/// iSAM2, International Journal of Robotics Research 31(2), 2012; each clique here has one frontal
/// variable). Every variable has to have a factor before update().
class BayesTree {
 public:
  int addVariable(int size);
  int addFactor(LinearFactor factor);
  /// Of the same variables, or of none: it has no say.
  void setFactor(int factor, LinearFactor to);
  const LinearFactor& factor(int factor) const { return factors_[index(factor)]; }

  /// Eliminates what has changed, with `last` last. False: the equations are singular, and so they
  /// remain.
  bool update(std::span<const int> last);
  /// What a variable has moved by. Solved for when it is asked for, together with those eliminated
  /// after it that it hangs on.
  Eigen::Map<const Eigen::VectorXd> x(int variable);
  /// Of the two last of `last` of the last update, which have to hang together, or of the last
  /// where it is alone.
  Eigen::MatrixXd covarianceOfLast() const;
  /// Variables eliminated by the last update.
  std::size_t eliminated() const { return order_.size(); }
  /// Entries of all that was passed on in that; its time goes with them.
  double work() const { return work_; }

 private:
  struct Node {
    int size = 0;
    Eigen::Index at = 0;  ///< in x
    // As eliminated: the factors none of whose variables went before; L of the rows of the
    // separator, too, S and s what is passed on to it.
    std::vector<int> factors;
    bool done = false;
    int parent = -1;
    std::vector<int> children;
    std::vector<int> separator;
    Eigen::MatrixXd L, S;
    Eigen::VectorXd y, s;
    std::size_t solved = 0;  ///< by which solution
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  Node& node(int variable) { return nodes_[index(variable)]; }

  void touch(const LinearFactor& factor);
  std::vector<int> takeTop();
  void putInOrder(const std::vector<int>& orphans, std::span<const int> last);
  /// Where, of these variables, the first to be eliminated is.
  int firstPosition(const std::vector<int>& variables) const;
  void assign(const std::vector<int>& orphans);
  bool eliminate(int variable);
  void solve(Node& here);
  /// Rows in front_ of variables one after another, into at_.
  void findRows(const std::vector<int>& variables);

  std::vector<Node> nodes_;
  std::vector<LinearFactor> factors_;
  std::vector<double> x_;
  std::vector<int> touched_;
  std::vector<int> fresh_;    ///< factors of no node
  std::vector<bool> listed_;  ///< factors of a node, or fresh
  std::vector<int> roots_;    ///< the last two
  double work_ = 0.0;
  std::size_t solution_ = 0;
  std::vector<int> asked_;
  // While something is eliminated:
  std::vector<int> order_;
  std::vector<int> free_;          ///< factors of variables in the order
  std::vector<int> position_;      ///< of variables in the order; -1: stays eliminated
  std::vector<Eigen::Index> row_;  ///< of a variable in the front; -1: not there
  std::vector<Eigen::Index> at_;
};

}  // namespace colonnade
