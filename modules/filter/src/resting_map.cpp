// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// What an exchange leaves to do is done within so many steps.
constexpr Eigen::Index kStepsToWorkOff = 12;
/// Parts of a change of P smaller than this share of its largest are left out: P stays larger.
constexpr double kNegligible = 1e-13;

bool before(const Block& block, LandmarkId id) { return block.id < id; }

/// Where the point, and where the direction of a block stands among its parameters; -1: none.
struct Layout {
  int point;
  int direction;
};
Layout layoutOf(BlockKind kind) {
  return kind == BlockKind::kAxis ? Layout{-1, 0} : Layout{0, kind == BlockKind::kPoint ? -1 : 2};
}

/// The rows of `from` at the parameters of these blocks; those of the robot first if it is there.
std::vector<Eigen::Index> indicesOf(const std::vector<Block>& blocks) {
  std::vector<Eigen::Index> indices;
  for (const Block& block : blocks)
    for (int i = 0; i < block.size(); ++i) indices.push_back(block.offset + i);
  return indices;
}

/// A factor D of the change C Psi C^T = D D^T, of as few columns as it takes.
Eigen::MatrixXd lowRankFactor(const Eigen::MatrixXd& C, const Eigen::MatrixXd& Psi) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> inner(Psi);
  const Eigen::MatrixXd F =
      inner.eigenvectors() * inner.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(C.cols(), C.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(C.transpose());
  const Eigen::MatrixXd outer =
      F.transpose() * (gram.selfadjointView<Eigen::Lower>() * F);  // D^T D before the cut
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(outer);
  const Eigen::VectorXd& lambda = spectrum.eigenvalues();
  if (lambda.size() == 0 || !(lambda(lambda.size() - 1) > 0.0))
    return Eigen::MatrixXd::Zero(C.rows(), 0);
  const Eigen::Index rank = (lambda.array() > kNegligible * lambda(lambda.size() - 1)).count();
  return C * (F * spectrum.eigenvectors().rightCols(rank));
}

}  // namespace

Block* RestingMap::find(LandmarkId id) {
  return const_cast<Block*>(static_cast<const RestingMap&>(*this).find(id));
}

const Block* RestingMap::find(LandmarkId id) const {
  const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), id, before);
  return at != blocks_.end() && at->id == id ? &*at : nullptr;
}

void RestingMap::remove(LandmarkId id) {
  std::erase_if(blocks_, [&](const Block& block) { return block.id == id; });
  slots_.erase(id);
}

Eigen::VectorXd RestingMap::values(const State& state) const {
  const Eigen::MatrixX3d step = C_ * state.transfer->theta;
  Eigen::VectorXd x = x_ + step.col(0);
  for (const Block& block : blocks_) {
    const Layout layout = layoutOf(block.block_kind);
    const Eigen::Index at = block.offset;
    if (layout.point >= 0) {
      x(at) = x_(at) + step(at, 1) - step(at + 1, 2);
      x(at + 1) = x_(at + 1) + step(at + 1, 1) + step(at, 2);
    }
    if (layout.direction >= 0) x(at + layout.direction) = wrapAngle(x(at + layout.direction));
  }
  return x;
}

Eigen::MatrixXd RestingMap::covariance(const Block& block) const {
  return Eigen::MatrixXd::NullaryExpr(block.size(), block.size(),
                                      [&](Eigen::Index row, Eigen::Index column) {
                                        return P_(block.offset + row, block.offset + column);
                                      });
}

Eigen::MatrixXd RestingMap::covarianceWithRobot(const Block& block, const State& state) const {
  return state.transfer->Phi.topRows<3>() * C_.middleRows(block.offset, block.size()).transpose();
}

Eigen::VectorXd RestingMap::worldTurn(const Eigen::VectorXd& x) const {
  Eigen::VectorXd G = Eigen::VectorXd::Zero(x.size());
  for (const Block& block : blocks_) {
    if (layoutOf(block.block_kind).point < 0) continue;
    G(block.offset) = -x(block.offset + 1);
    G(block.offset + 1) = x(block.offset);
  }
  return G;
}

void RestingMap::addOwed(const Eigen::MatrixXd& D, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd all(D.rows(), owed_.cols() + D.cols());
  if (owed_.cols() > 0) all.leftCols(owed_.cols()) = owed_;
  all.rightCols(D.cols()) = D;
  owed_ = std::move(all);
  weights_.conservativeResize(owed_.cols());
  weights_.tail(D.cols()) = weights;
}

void RestingMap::settleDebts() {
  if (owed_.cols() > 0)
    for (; panels_done_ < P_.panels(); ++panels_done_) P_.addToPanel(panels_done_, owed_, weights_);
  panels_done_ = 0;
  owed_.resize(x_.size(), 0);
  weights_.resize(0);
}

void RestingMap::workOff() {
  if (owed_.cols() == 0) return;
  // Panel k has k + 1 times the work of the first.
  const Eigen::Index panels = P_.panels();
  Eigen::Index budget = panels * (panels + 1) / 2 / kStepsToWorkOff + panels;
  while (panels_done_ < panels && budget > 0) {
    P_.addToPanel(panels_done_, owed_, weights_);
    budget -= ++panels_done_;
  }
  if (panels_done_ == panels) settleDebts();
}

void RestingMap::exchange(State& state, const std::vector<LandmarkId>& active, bool invariant) {
  const auto isActive = [&](const Block& block) {
    return std::binary_search(active.begin(), active.end(), block.id);
  };
  // The resting part up to now: values, covariance X with the state, what is owed to its own.
  settleDebts();
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(x_.size(), state.x.size());
  if (state.transfer) {
    const Transfer& transfer = *state.transfer;
    X.noalias() = C_ * transfer.Phi.transpose();
    const Eigen::VectorXd now = values(state);
    const Eigen::VectorXd g = worldTurn(now) - worldTurn(x_);
    x_ = now;
    const Eigen::MatrixXd D = lowRankFactor(C_, transfer.Psi);
    addOwed(D, Eigen::VectorXd::Constant(D.cols(), -1.0));
    if (invariant) {
      // M = I + g e^T for the resting points: P + g w^T + w g^T with w = h + v/2 g, as a
      // difference of two squares.
      const Eigen::VectorXd w = X.col(2) + 0.5 * state.P(2, 2) * g;
      Eigen::MatrixXd squares(g.size(), 2);
      squares << g + w, g - w;
      addOwed(squares, Eigen::Vector2d(0.5, -0.5));
      X.noalias() += g * state.P.row(2);
    }
  }

  std::vector<Block> kept, leaving, entering, resting;
  std::partition_copy(state.blocks.begin(), state.blocks.end(), std::back_inserter(kept),
                      std::back_inserter(leaving), isActive);
  std::partition_copy(blocks_.begin(), blocks_.end(), std::back_inserter(entering),
                      std::back_inserter(resting), isActive);

  // Covariance of what enters with all that rested.
  const std::vector<Eigen::Index> in = indicesOf(entering);
  Eigen::MatrixXd E(x_.size(), static_cast<Eigen::Index>(in.size()));
  for (std::size_t i = 0; i < in.size(); ++i)
    E.col(static_cast<Eigen::Index>(i)) = P_.column(in[i]);
  if (owed_.cols() > 0 && !in.empty())
    E.noalias() += owed_ * (weights_.asDiagonal() * owed_(in, Eigen::all).transpose());

  // What leaves takes its slots. Nothing is owed to what is written now, nor to what leaves here.
  const Eigen::Index former_size = x_.size();
  Eigen::Index size = former_size;
  for (const Block& block : leaving) {
    auto [slot, fresh] = slots_.try_emplace(block.id, Slot{size, block.size()});
    if (fresh) size += block.size();
    resting.push_back(block);
    resting.back().offset = static_cast<int>(slot->second.offset);
  }
  const auto growRows = [&](Eigen::MatrixXd& matrix) {
    matrix.conservativeResize(size, Eigen::NoChange);
    matrix.bottomRows(size - former_size).setZero();
  };
  x_.conservativeResize(size);
  P_.grow(size);
  growRows(X);
  growRows(E);
  growRows(owed_);
  const std::vector<Eigen::Index> out = indicesOf(leaving);
  const std::vector<Eigen::Index> out_slots =
      indicesOf({resting.end() - static_cast<std::ptrdiff_t>(leaving.size()), resting.end()});
  x_(out_slots) = state.x(out);
  owed_(out_slots, Eigen::all).setZero();
  owed_(in, Eigen::all).setZero();
  X(out_slots, Eigen::all) = state.P(out, Eigen::all);
  E(out_slots, Eigen::all) = X(in, out).transpose();
  for (std::size_t i = 0; i < out.size(); ++i) P_.setRowAndColumn(out_slots[i], X.col(out[i]));

  // The new state: the robot, and what is active in the order of birth.
  State next;
  std::vector<Eigen::Index> from_state{0, 1, 2}, to_state{0, 1, 2}, to_entering;
  std::vector<Block> blocks = kept;
  blocks.insert(blocks.end(), entering.begin(), entering.end());
  std::sort(blocks.begin(), blocks.end(),
            [](const Block& a, const Block& b) { return a.id < b.id; });
  Eigen::Index n = 3;
  for (Block& block : blocks) {
    const bool comes = find(block.id) != nullptr;
    for (int i = 0; i < block.size(); ++i) {
      if (!comes) from_state.push_back(block.offset + i);
      (comes ? to_entering : to_state).push_back(n + i);
    }
    block.offset = static_cast<int>(n);
    n += block.size();
  }
  next.blocks = std::move(blocks);
  next.x.resize(n);
  next.x(to_state) = state.x(from_state);
  next.x(to_entering) = x_(in);
  next.P.resize(n, n);
  next.P(to_state, to_state) = state.P(from_state, from_state);
  next.P(to_entering, to_state) = X(in, from_state);
  next.P(to_state, to_entering) = X(in, from_state).transpose();
  const Eigen::MatrixXd P_in = E(in, Eigen::all);
  next.P(to_entering, to_entering) = 0.5 * (P_in + P_in.transpose());

  std::sort(resting.begin(), resting.end(),
            [](const Block& a, const Block& b) { return a.id < b.id; });
  blocks_ = std::move(resting);
  if (blocks_.empty()) {
    *this = RestingMap();
  } else {
    const std::vector<Eigen::Index> rows = indicesOf(blocks_);
    C_ = Eigen::MatrixXd::Zero(size, n);
    C_(rows, to_state) = X(rows, from_state);
    C_(rows, to_entering) = E(rows, Eigen::all);
    next.transfer = Transfer{Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                             Eigen::MatrixX3d::Zero(n, 3)};
  }
  state = std::move(next);
}

}  // namespace colonnade
