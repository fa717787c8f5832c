// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "colonnade/filter/state.hpp"
#include "colonnade/filter/symmetric_panels.hpp"

namespace colonnade {

/// The part of a large map the robot does not work with at present. A step of the filter costs
/// nothing for it: what it learns stands in State::transfer, and follows when blocks are exchanged
/// (compressed filter; Guivant and Nebot, IEEE T-RA 17(3), 2001). With the plain EKF an exchange
/// leaves exactly what the full filter would have. With right-invariant transport the resting
/// points are transported once, by the whole way they moved, in place of once for each correction:
/// the direction nobody observes is kept just as well, the numbers differ in second order.
///
/// The covariance of resting with resting blocks is the one thing that is large. Its change since
/// an exchange is of low rank, is kept as such, and is added a few panels at a time by workOff().
class RestingMap {
 public:
  bool empty() const { return blocks_.empty(); }
  const std::vector<Block>& blocks() const { return blocks_; }  ///< by identity; offsets: own ones
  Block* find(LandmarkId id);
  const Block* find(LandmarkId id) const;

  /// The values of all resting blocks as of now, at their offsets.
  Eigen::VectorXd values(const State& state) const;
  /// Covariance of a resting block as of the last exchange: since then it can only have lost.
  Eigen::MatrixXd covariance(const Block& block) const;
  /// Covariance of the robot with a resting block as of now (3 x size).
  Eigen::MatrixXd covarianceWithRobot(const Block& block, const State& state) const;

  /// Brings the resting part up to date and exchanges blocks: afterwards the state holds the blocks
  /// of `active` (ascending; all of them known here or there), and the others rest.
  void exchange(State& state, const std::vector<LandmarkId>& active, bool invariant);
  /// A part of the work the last exchange left.
  void workOff();
  void remove(LandmarkId id);

 private:
  struct Slot {
    Eigen::Index offset = 0;
    Eigen::Index size = 0;
  };
  void addOwed(const Eigen::MatrixXd& D, const Eigen::VectorXd& weights);
  void settleDebts();
  Eigen::VectorXd worldTurn(const Eigen::VectorXd& x) const;

  std::vector<Block> blocks_;         ///< those that rest; offset: that of the slot
  std::map<LandmarkId, Slot> slots_;  ///< once given, a block's for good
  Eigen::VectorXd x_;
  SymmetricPanels P_;     ///< rows of slots whose block does not rest mean nothing
  Eigen::MatrixXd C_;     ///< covariance with the state at the last exchange; see Transfer
  Eigen::MatrixXd owed_;  ///< D: P_ still lacks D diag(weights) D^T ...
  Eigen::VectorXd weights_;
  Eigen::Index panels_done_ = 0;  ///< ... from this panel on
};

}  // namespace colonnade
