// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// So many columns of the debt are paid together: P is passed through once for all of them.
constexpr Eigen::Index kColumnsTogether = 32;
/// Over so many steps, unless more columns come meanwhile.
constexpr Eigen::Index kStepsToWorkOff = 32;
/// Parts of a change of P smaller than this share of its largest are rounding.
constexpr double kRounding = 1e-13;
/// What is negligible is judged on at most so many resting blocks, evenly spread over all.
constexpr std::size_t kBlocksJudged = 500;

bool before(const Block& block, LandmarkId id) { return block.id < id; }

/// Where the point, and where the direction of a block stands among its parameters; -1: none.
struct Layout {
  int point;
  int direction;
};
Layout layoutOf(BlockKind kind) {
  return kind == BlockKind::kAxis ? Layout{-1, 0} : Layout{0, kind == BlockKind::kPoint ? -1 : 2};
}

/// The rows of the parameters of these blocks.
std::vector<Eigen::Index> indicesOf(const std::vector<Block>& blocks) {
  std::vector<Eigen::Index> indices;
  for (const Block& block : blocks)
    for (int i = 0; i < block.size(); ++i) indices.push_back(block.offset + i);
  return indices;
}

/// The parameters of the state at the last exchange by which the state changed: the robot's and
/// those measured. Where Psi is zero, Phi says only where a parameter went: it is that of the
/// identity, but for blocks that were removed or converted.
std::vector<Eigen::Index> supportOf(const Transfer& transfer) {
  std::vector<Eigen::Index> support;
  for (Eigen::Index i = 0; i < transfer.Psi.rows(); ++i)
    if (i < 3 || transfer.Psi(i, i) != 0.0) support.push_back(i);
  return support;
}

/// Psi = F F^T.
Eigen::MatrixXd squareRoot(const Eigen::MatrixXd& Psi) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Psi);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// How many of the last columns of a factor make up its square but for rounding; the columns are
/// in the order of their squares.
Eigen::Index rankOf(const Eigen::VectorXd& squares) {
  const Eigen::Index size = squares.size();
  if (size == 0 || !(squares(size - 1) > 0.0)) return 0;
  return (squares.array() > kRounding * squares(size - 1)).count();
}

/// How many of the first columns of `parts` can go before the sum of their squares is more than
/// `negligible` in a row.
Eigen::Index negligibleColumns(const Eigen::MatrixXd& parts, double negligible) {
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(parts.rows());
  for (Eigen::Index column = 0; column < parts.cols(); ++column) {
    lost += parts.col(column).cwiseAbs2();
    if (lost.maxCoeff() > negligible) return column;
  }
  return parts.cols();
}

/// A with D D^T = C Psi C^T for D = C A, of as few columns as it takes for the rows of `C_judged`:
/// those of C, or a part of them in units of their deviations, of whose variances a share of
/// `negligible` may be left out.
Eigen::MatrixXd lowRankFactor(const Eigen::MatrixXd& C_judged, const Eigen::MatrixXd& Psi,
                              double negligible) {
  const Eigen::MatrixXd F = squareRoot(Psi);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(Psi.rows(), Psi.rows());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(C_judged.transpose());
  const Eigen::MatrixXd outer = F.transpose() * (gram.selfadjointView<Eigen::Lower>() * F);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(outer);
  Eigen::MatrixXd A = F * spectrum.eigenvectors().rightCols(rankOf(spectrum.eigenvalues()));
  if (negligible <= 0.0) return A;
  return A.rightCols(A.cols() - negligibleColumns(C_judged * A, negligible)).eval();
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
  Eigen::VectorXd x = x_;
  for (const Block& block : blocks_)
    x.segment(block.offset, block.size()) =
        moved(block, step.middleRows(block.offset, block.size()));
  return x;
}

BlockVector RestingMap::moved(const Block& block,
                              const Eigen::Ref<const Eigen::MatrixX3d>& step) const {
  BlockVector y = x_.segment(block.offset, block.size()) + step.col(0);
  const Layout layout = layoutOf(block.block_kind);
  if (layout.point >= 0) {
    y(0) = x_(block.offset) + step(0, 1) - step(1, 2);
    y(1) = x_(block.offset + 1) + step(1, 1) + step(0, 2);
  }
  if (layout.direction >= 0) y(layout.direction) = wrapAngle(y(layout.direction));
  return y;
}

double RestingMap::covarianceAt(Eigen::Index row, Eigen::Index column) const {
  const bool paid = SymmetricPanels::panelOf(std::max(row, column)) < panels_done_;
  const Eigen::Index owed = owed_.cols() - (paid ? paying_ : 0);
  return P_(row, column) + owed_.row(row)
                               .tail(owed)
                               .cwiseProduct(owed_.row(column).tail(owed))
                               .dot(weights_.tail(owed).transpose());
}

RestingMap::Marginal RestingMap::marginal(const Block& block, const State& state) const {
  Marginal marginal;
  marginal.y = moved(block, C_.middleRows(block.offset, block.size()) * state.transfer->theta);
  marginal.P = Eigen::MatrixXd::NullaryExpr(
      block.size(), block.size(), [&](Eigen::Index row, Eigen::Index column) {
        return covarianceAt(block.offset + row, block.offset + column);
      });
  marginal.P_robot =
      state.transfer->Phi.topRows<3>() * C_.middleRows(block.offset, block.size()).transpose();
  if (!invariant_) return marginal;
  const Eigen::VectorXd g = turnOfWay(block, marginal.y);
  const Eigen::VectorXd w = marginal.P_robot.row(2).transpose() + 0.5 * state.P(2, 2) * g;
  marginal.P += g * w.transpose() + w * g.transpose();
  marginal.P_robot += state.P.block<3, 1>(0, 2) * g.transpose();
  return marginal;
}

double RestingMap::largestMove(const State& state) const {
  const auto length = [&](Eigen::Index column) {
    const auto theta = state.transfer->theta.col(column);
    return std::sqrt(std::max(0.0, theta.dot(P_state_ * theta)));
  };
  return length(1) + length(2);
}

BlockVector RestingMap::turnOfWay(const Block& block, const BlockVector& y) const {
  BlockVector g = BlockVector::Zero(block.size());
  if (layoutOf(block.block_kind).point < 0) return g;
  const BlockVector way = y - x_transported_.segment(block.offset, block.size());
  g(0) = -way(1);
  g(1) = way(0);
  return g;
}

void RestingMap::addOwed(const Eigen::MatrixXd& D, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd all(D.rows(), owed_.cols() + D.cols());
  if (owed_.cols() > 0) all.leftCols(owed_.cols()) = owed_;
  all.rightCols(D.cols()) = D;
  owed_ = std::move(all);
  weights_.conservativeResize(owed_.cols());
  weights_.tail(D.cols()) = weights;
}

void RestingMap::pay(Eigen::Index panel) {
  P_.addToPanel(panel, owed_.leftCols(paying_), weights_.head(paying_));
}

void RestingMap::closeAccount() {
  owed_ = owed_.rightCols(owed_.cols() - paying_).eval();
  weights_ = weights_.tail(owed_.cols()).eval();
  paying_ = panels_done_ = 0;
}

void RestingMap::settleDebts() {
  for (; paying_ > 0 && panels_done_ < P_.panels(); ++panels_done_) pay(panels_done_);
  closeAccount();
  paying_ = owed_.cols();
  for (; paying_ > 0 && panels_done_ < P_.panels(); ++panels_done_) pay(panels_done_);
  closeAccount();
}

void RestingMap::workOff() {
  if (paying_ == 0 && owed_.cols() >= kColumnsTogether) paying_ = owed_.cols();
  if (paying_ == 0) return;
  // Panel k has k + 1 times the work of the first.
  const Eigen::Index panels = P_.panels();
  const Eigen::Index times = 1 + (owed_.cols() - paying_) / kColumnsTogether;
  Eigen::Index budget = times * panels * (panels + 1) / 2 / kStepsToWorkOff + 1;
  for (; panels_done_ < panels && budget > 0; budget -= ++panels_done_) pay(panels_done_);
  if (panels_done_ == panels) closeAccount();
}

Eigen::MatrixXd RestingMap::columnsNow(const std::vector<Eigen::Index>& columns) const {
  Eigen::MatrixXd E(x_.size(), static_cast<Eigen::Index>(columns.size()));
  std::vector<Eigen::Index> unpaid;  // columns of panels that are not paid yet
  const Eigen::Index first_unpaid = std::min(x_.size(), SymmetricPanels::firstRow(panels_done_));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    E.col(static_cast<Eigen::Index>(i)) = P_.column(columns[i]);
    if (columns[i] < first_unpaid) continue;
    unpaid.push_back(static_cast<Eigen::Index>(i));
  }
  if (owed_.cols() == 0 || columns.empty()) return E;
  const Eigen::MatrixXd right = weights_.asDiagonal() * owed_(columns, Eigen::all).transpose();
  const Eigen::Index unpaid_size = x_.size() - first_unpaid;
  E.bottomRows(unpaid_size).noalias() += owed_.bottomRows(unpaid_size) * right;
  const Eigen::Index fresh = owed_.cols() - paying_;
  E.topRows(first_unpaid).noalias() +=
      owed_.topRightCorner(first_unpaid, fresh) * right.bottomRows(fresh);
  if (paying_ > 0 && first_unpaid > 0 && !unpaid.empty())
    E.topRows(first_unpaid)(Eigen::all, unpaid) +=
        owed_.topLeftCorner(first_unpaid, paying_) * right.topRows(paying_)(Eigen::all, unpaid);
  return E;
}

Eigen::VectorXd RestingMap::variances() const {
  Eigen::VectorXd variances = owed_.cwiseAbs2() * weights_;
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    const bool paid = SymmetricPanels::panelOf(i) < panels_done_;
    if (paid && paying_ > 0)
      variances(i) = covarianceAt(i, i);
    else
      variances(i) += P_(i, i);
  }
  return variances;
}

Eigen::MatrixXd RestingMap::judged(const std::vector<Eigen::Index>& columns) const {
  const std::size_t stride =
      std::max<std::size_t>(1, (blocks_.size() + kBlocksJudged - 1) / kBlocksJudged);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < blocks_.size(); i += stride)
    for (int k = 0; k < blocks_[i].size(); ++k) rows.push_back(blocks_[i].offset + k);
  const Eigen::MatrixXd C = C_(rows, columns);
  const auto inverse = [](double variance) {
    return variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
  };
  return variance_(rows).unaryExpr(inverse).asDiagonal() * C;
}

void RestingMap::exchange(State& state, const std::vector<LandmarkId>& active, bool invariant,
                          double negligible) {
  const auto isActive = [&](const Block& block) {
    return std::binary_search(active.begin(), active.end(), block.id);
  };
  invariant_ = invariant;
  // The resting part up to now: values, covariance X with the state, what is owed to its own.
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(x_.size(), state.x.size());
  if (state.transfer) {
    const Transfer& transfer = *state.transfer;
    const std::vector<Eigen::Index> support = supportOf(transfer);
    const Eigen::MatrixXd C = C_(Eigen::all, support);
    X.noalias() = C * transfer.Phi(Eigen::all, support).transpose();
    for (Eigen::Index j = 3; j < transfer.Phi.cols(); ++j) {
      if (transfer.Psi(j, j) != 0.0) continue;
      for (Eigen::Index i = 0; i < transfer.Phi.rows(); ++i)
        if (transfer.Phi(i, j) != 0.0) X.col(i) += transfer.Phi(i, j) * C_.col(j);
    }
    x_ = values(state);
    const Eigen::MatrixXd D = C * lowRankFactor(negligible > 0.0 ? judged(support) : C,
                                                transfer.Psi(support, support), negligible);
    addOwed(D, Eigen::VectorXd::Constant(D.cols(), -1.0));
  }

  std::vector<Block> kept, leaving, entering, resting;
  std::partition_copy(state.blocks.begin(), state.blocks.end(), std::back_inserter(kept),
                      std::back_inserter(leaving), isActive);
  std::partition_copy(blocks_.begin(), blocks_.end(), std::back_inserter(entering),
                      std::back_inserter(resting), isActive);

  // Covariance of what enters with all that rested.
  const std::vector<Eigen::Index> in = indicesOf(entering);
  if (resting.empty()) settleDebts();
  Eigen::MatrixXd E = columnsNow(in);
  if (invariant) {
    // M = I + g e^T for the points that enter, by their whole way since they came to rest.
    Eigen::VectorXd g = Eigen::VectorXd::Zero(x_.size());
    for (const Block& block : entering)
      g.segment(block.offset, block.size()) =
          turnOfWay(block, x_.segment(block.offset, block.size()));
    const Eigen::VectorXd g_in = g(in);
    const Eigen::VectorXd w = X.col(2) + 0.5 * state.P(2, 2) * g;
    const Eigen::VectorXd w_in = w(in);
    E += w * g_in.transpose();
    E(in, Eigen::all) += g_in * w_in.transpose();
    X(in, Eigen::all) += g_in * state.P.row(2);
  }

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
  x_transported_.conservativeResize(size);
  P_.grow(size);
  growRows(X);
  growRows(E);
  growRows(owed_);
  const std::vector<Eigen::Index> out = indicesOf(leaving);
  const std::vector<Eigen::Index> out_slots =
      indicesOf({resting.end() - static_cast<std::ptrdiff_t>(leaving.size()), resting.end()});
  x_(out_slots) = state.x(out);
  x_transported_(out_slots) = state.x(out);
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
    P_state_ = next.P;
    variance_ = variances();
  }
  state = std::move(next);
}

}  // namespace colonnade
