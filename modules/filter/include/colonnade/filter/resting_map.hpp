// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "colonnade/filter/resting_covariance.hpp"
#include "colonnade/filter/state.hpp"

namespace colonnade {

class Passage;

/// The part of a large map the robot does not work with at present. A step of the filter costs
/// nothing for it: what it learns stands in State::transfer, and follows when blocks are exchanged
/// (compressed filter; Guivant and Nebot, IEEE T-RA 17(3), 2001). With the plain EKF an exchange
/// leaves exactly what the full filter would have. With right-invariant transport the resting
/// points are transported once, as they enter, in place of once for each correction:
/// the direction nobody observes is kept just as well, the numbers differ in second order.
///
/// The covariance of resting with resting blocks follows in its own time: see RestingCovariance.
class RestingMap {
 public:
  bool empty() const { return blocks_.empty(); }
  const std::vector<Block>& blocks() const { return blocks_; }  ///< by identity; offsets: own ones
  Block* find(LandmarkId id);
  const Block* find(LandmarkId id) const;

  /// A resting block as of now: its values, its covariance (as of the last exchange: since then it
  /// can only have lost) and that of some rows of the state with it.
  struct Marginal {
    BlockVector y;
    Eigen::MatrixXd P;
    Eigen::MatrixXd P_state;
  };
  Marginal marginal(const Block& block, const State& state,
                    const std::vector<Eigen::Index>& rows_of_state) const;
  /// The values of a resting block as of the last exchange.
  BlockVector valueThen(const Block& block) const { return x_.segment(block.offset, block.size()); }
  /// No resting point has moved farther since the last exchange than so many of its deviations:
  /// |C theta| <= sigma sqrt(theta^T P theta), P the covariance of the state at that exchange.
  double largestMove(const State& state) const;
  /// The variance of the first two parameters of a block together, as of the last exchange.
  double spread2(const Block& block) const { return variance_.segment<2>(block.offset).sum(); }

  /// Brings the resting part up to date and exchanges blocks: afterwards the state holds the blocks
  /// of `active` (ascending; all of them known here or there), and the others rest. Of what the
  /// resting blocks gained, parts are left out for good that lower no judged variance (of
  /// parameters evenly spread) by more than a share of `negligible`: the covariance of all stays
  /// the true one plus something positive semidefinite.
  void exchange(State& state, const std::vector<LandmarkId>& active, bool invariant,
                double negligible);
  /// A part of the work the exchanges left.
  void workOff() { P_.workOff(); }
  void remove(LandmarkId id);

 private:
  struct Entering;
  /// By `C`, the covariance of these blocks with the state at the last exchange.
  Entering entering(std::vector<Block> blocks, const State& state, const Eigen::MatrixXd& C) const;
  /// A^T with C A (C A)^T what the covariance of the resting part loses, but for what is
  /// negligible.
  Eigen::MatrixXd gain(const Passage& passage, double negligible) const;
  /// Slots for blocks that come to rest; their offsets become those.
  void giveSlots(std::vector<Block>& arriving);
  /// Their slots are for others.
  void vacate(std::span<const Block> leaving);
  BlockVector moved(const Block& block, const Eigen::Ref<const Eigen::MatrixX3d>& step) const;
  /// The rows by which it is judged what is negligible: all, or some evenly spread.
  std::vector<Eigen::Index> judged(double negligible) const;
  /// How far the block's own turn G has gone at `y` since its covariance was last transported.
  BlockVector turnOfWay(const Block& block, const BlockVector& y) const;

  std::vector<Block> blocks_;             ///< those that rest; offset: that of the slot
  std::set<std::pair<int, int>> vacant_;  ///< slots by size and offset
  Eigen::VectorXd x_;
  Eigen::VectorXd x_transported_;  ///< what the covariance was last transported to
  bool invariant_ = false;         ///< whether it is transported at all
  std::vector<bool> rests_;        ///< rows of other slots mean nothing, and are zero in C_
  RestingCovariance P_;
  RowPanels C_;               ///< covariance with the state at the last exchange; see Transfer
  Eigen::MatrixXd P_state_;   ///< covariance of the state at the last exchange
  Eigen::VectorXd variance_;  ///< of every resting parameter at the last exchange
};

}  // namespace colonnade
