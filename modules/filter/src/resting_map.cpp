// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "colonnade/base/angle.hpp"
#include "low_rank.hpp"
#include "panel_product.hpp"
#include "passage.hpp"

namespace colonnade {
namespace {

using Index = Eigen::Index;
using Indices = std::vector<Index>;
constexpr Index kRows = RowPanels::kRows;

/// What is negligible is judged on at most about so many rows, evenly spread over all that rest ...
constexpr std::size_t kRowsJudged = 400;
/// ... as many together as lie in one line of the cache.
constexpr std::size_t kRowsTogether = 8;

bool before(const Block& block, LandmarkId id) { return block.id < id; }
bool older(const Block& a, const Block& b) { return a.id < b.id; }

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The rows of the parameters of these blocks.
Indices indicesOf(const std::vector<Block>& blocks) {
  Indices indices;
  for (const Block& block : blocks)
    for (int i = 0; i < block.size(); ++i) indices.push_back(block.offset + i);
  return indices;
}

/// Rows with places in one order, visited panel by panel.
class RowsByPanel {
 public:
  explicit RowsByPanel(const Indices& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows_.emplace_back(rows[i], static_cast<Index>(i));
    std::sort(rows_.begin(), rows_.end());
  }
  /// Calls visit(row within the panel, place) for those of this panel; panels in ascending order.
  template <class Visit>
  void of(Index panel, Visit visit) {
    for (; next_ < rows_.size() && RowPanels::panelOf(rows_[next_].first) == panel; ++next_)
      visit(rows_[next_].first % kRows, rows_[next_].second);
  }

 private:
  std::vector<std::pair<Index, Index>> rows_;
  std::size_t next_ = 0;
};

}  // namespace

Block* RestingMap::find(LandmarkId id) {
  return const_cast<Block*>(static_cast<const RestingMap&>(*this).find(id));
}

const Block* RestingMap::find(LandmarkId id) const {
  const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), id, before);
  return at != blocks_.end() && at->id == id ? &*at : nullptr;
}

void RestingMap::remove(LandmarkId id) {
  const Block* block = find(id);
  if (!block) return;
  vacate({block, 1});
  blocks_.erase(blocks_.begin() + (block - blocks_.data()));
}

void RestingMap::vacate(std::span<const Block> leaving) {
  for (const Block& block : leaving) {
    for (int i = 0; i < block.size(); ++i) rests_[at(block.offset + i)] = false;
    vacant_.emplace(block.size(), block.offset);
  }
}

BlockVector RestingMap::moved(const Block& block,
                              const Eigen::Ref<const Eigen::MatrixX3d>& step) const {
  BlockVector y = x_.segment(block.offset, block.size()) + step.col(0);
  const BlockLayout layout = layoutOf(block.block_kind);
  if (layout.point >= 0) {
    y(0) = x_(block.offset) + step(0, 1) - step(1, 2);
    y(1) = x_(block.offset + 1) + step(1, 1) + step(0, 2);
  }
  if (layout.direction >= 0) y(layout.direction) = wrapAngle(y(layout.direction));
  return y;
}

RestingMap::Marginal RestingMap::marginal(const Block& block, const State& state,
                                          const Indices& rows_of_state) const {
  Indices rows;
  for (int i = 0; i < block.size(); ++i) rows.push_back(block.offset + i);
  const Eigen::MatrixXd C = C_.rows(rows);
  Marginal marginal;
  marginal.y = moved(block, C * state.transfer->theta);
  marginal.P = Eigen::MatrixXd::NullaryExpr(
      block.size(), block.size(),
      [&](Index row, Index column) { return P_(block.offset + row, block.offset + column); });
  marginal.P_state = state.transfer->Phi(rows_of_state, Eigen::all) * C.transpose();
  if (!invariant_) return marginal;
  const Eigen::VectorXd g = turnOfWay(block, marginal.y);
  const Eigen::VectorXd w = C * state.transfer->Phi.row(2).transpose() + 0.5 * state.P(2, 2) * g;
  marginal.P += g * w.transpose() + w * g.transpose();
  marginal.P_state += state.P(rows_of_state, 2) * g.transpose();
  return marginal;
}

double RestingMap::largestMove(const State& state) const {
  const auto length = [&](Index column) {
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

Indices RestingMap::judged(double negligible) const {
  std::vector<std::size_t> groups;
  for (std::size_t row = 0; row < rests_.size();
       row += rests_[row] ? kRowsTogether - row % kRowsTogether : 1)
    if (rests_[row]) groups.push_back(row / kRowsTogether);
  const std::size_t most = negligible > 0.0 ? kRowsJudged / kRowsTogether : groups.size();
  const std::size_t stride =
      std::max<std::size_t>(1, (groups.size() + most - 1) / std::max<std::size_t>(1, most));
  Indices rows;
  for (std::size_t g = 0; g < groups.size(); g += stride)
    for (std::size_t row = groups[g] * kRowsTogether;
         row < std::min(rests_.size(), (groups[g] + 1) * kRowsTogether); ++row)
      if (rests_[row]) rows.push_back(static_cast<Index>(row));
  return rows;
}

Eigen::MatrixXd RestingMap::gain(const Passage& passage, double negligible) const {
  const Indices rows = judged(negligible);
  Eigen::MatrixXd C_judged = C_.rows(rows, passage.support());
  if (negligible > 0.0) {
    const auto inverse = [](double variance) {
      return variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
    };
    C_judged = variance_(rows).unaryExpr(inverse).asDiagonal() * C_judged;
  }
  return lowRankFactor(C_judged, passage.Psi(), negligible).transpose();
}

void RestingMap::giveSlots(std::vector<Block>& arriving) {
  int size = static_cast<int>(x_.size());
  for (Block& block : arriving) {
    const auto slot = vacant_.lower_bound({block.size(), 0});
    if (slot != vacant_.end() && slot->first == block.size()) {
      block.offset = slot->second;
      vacant_.erase(slot);
    } else {
      block.offset = size;
      size += block.size();
    }
  }
  x_.conservativeResize(size);
  x_transported_.conservativeResize(size);
  variance_.conservativeResize(size);
  rests_.resize(at(size), false);
  P_.grow(size);
  C_.growRows(size);
}

/// What enters the state: its values, and its covariance with the state as it was.
struct RestingMap::Entering {
  std::vector<Block> blocks;  ///< by slot
  Indices rows;
  Eigen::VectorXd x;
  Eigen::MatrixXd X;  ///< transported
  Eigen::VectorXd g;  ///< of the transport M = I + g e^T, by the whole way since it came to rest
  Eigen::VectorXd w;  ///< M P M^T = P + g w^T + w g^T
};

RestingMap::Entering RestingMap::entering(std::vector<Block> blocks, const State& state,
                                          const Eigen::MatrixXd& C) const {
  Entering in{std::move(blocks), {}, {}, {}, {}, {}};
  in.rows = indicesOf(in.blocks);
  const auto n = static_cast<Index>(in.rows.size());
  in.x.resize(n);
  in.X.resize(n, state.x.size());
  in.g.setZero(n);
  in.w.setZero(n);
  if (n == 0) return in;
  const Eigen::MatrixX3d step = C * state.transfer->theta;
  in.X.noalias() = C * state.transfer->Phi.transpose();
  in.w = in.X.col(2);
  for (Index row = 0; const Block& block : in.blocks) {
    in.x.segment(row, block.size()) = moved(block, step.middleRows(row, block.size()));
    if (invariant_)
      in.g.segment(row, block.size()) = turnOfWay(block, in.x.segment(row, block.size()));
    row += block.size();
  }
  in.w += 0.5 * state.P(2, 2) * in.g;
  in.X += in.g * state.P.row(2);
  return in;
}

void RestingMap::exchange(State& state, const std::vector<LandmarkId>& active, bool invariant,
                          double negligible) {
  invariant_ = invariant;
  const Index n_before = state.x.size();
  const auto isActive = [&](const Block& block) {
    return std::binary_search(active.begin(), active.end(), block.id);
  };
  std::vector<Block> kept, leaving, woken;
  std::partition_copy(state.blocks.begin(), state.blocks.end(), std::back_inserter(kept),
                      std::back_inserter(leaving), isActive);
  std::copy_if(blocks_.begin(), blocks_.end(), std::back_inserter(woken), isActive);
  std::erase_if(blocks_, isActive);
  if (blocks_.empty()) P_.settle();
  std::sort(woken.begin(), woken.end(),
            [](const Block& a, const Block& b) { return a.offset < b.offset; });

  // What the resting part loses by what the state went through.
  std::optional<Passage> passage;
  Eigen::MatrixXd At;
  if (state.transfer) {
    passage.emplace(*state.transfer);
    At = gain(*passage, negligible);
  }
  const Index first_owed = P_.owe(At.rows());
  const Strips At_strips(At);

  const Indices rows_woken = indicesOf(woken);
  const Eigen::MatrixXd C_in = C_.rows(rows_woken);
  const Entering in = entering(std::move(woken), state, C_in);
  const auto n_in = in.x.size();
  Eigen::MatrixXd newest_in(n_in, At.rows());
  if (passage) newest_in = productOfRows(C_in(Eigen::all, passage->support()), At);
  const RestingCovariance::Columns columns_in = P_.columns(in.rows, newest_in);

  // What leaves the state takes the slots of what enters it: the same lines of memory are read and
  // written.
  const Indices out = indicesOf(leaving);
  vacate(in.blocks);
  giveSlots(leaving);
  const Indices out_slots = indicesOf(leaving);
  for (const Index row : out_slots) rests_[at(row)] = true;

  // The new state: the robot, and what is active in the order of birth.
  State next;
  next.sensor = state.sensor;
  Indices from_state{0, 1, 2}, to_state{0, 1, 2}, to_entering;
  next.blocks = kept;
  next.blocks.insert(next.blocks.end(), in.blocks.begin(), in.blocks.end());
  std::sort(next.blocks.begin(), next.blocks.end(), older);
  Index n = 3;
  for (Block& block : next.blocks) {
    if (state.find(block.id)) {
      for (int i = 0; i < block.size(); ++i) {
        from_state.push_back(block.offset + i);
        to_state.push_back(n + i);
      }
    }
    block.offset = static_cast<int>(n);
    n += block.size();
  }
  for (const Block& block : in.blocks)
    for (int i = 0; i < block.size(); ++i) to_entering.push_back(next.find(block.id)->offset + i);
  next.x.resize(n);
  next.x(to_state) = state.x(from_state);
  next.x(to_entering) = in.x;

  // Panel by panel, each while it is in the cache: what rests follows; X, its covariance with the
  // former state, and E, with what enters; from both the new C, and the covariance of what leaves
  // with all that rests.
  RowsByPanel rows_in(in.rows), rows_out(out_slots);
  Eigen::MatrixXd P_in(n_in, n_in), C_support, X(kRows, n_before), E(kRows, n_in);
  C_.setCols(std::max(C_.cols(), n));
  Eigen::MatrixX3d step = Eigen::MatrixX3d::Zero(C_.panels() * kRows, 3);
  for (Index panel = 0; panel < C_.panels(); ++panel) {
    X.setZero();
    if (passage) {
      passage->gather(C_, panel, C_support);
      step.middleRows<kRows>(panel * kRows) = passage->step(C_support);
      addPanelProduct(P_.owed().column(panel, first_owed), C_support.data(), At_strips);
      const Index count = std::min(kRows, variance_.size() - panel * kRows);
      variance_.segment(panel * kRows, count) -=
          P_.owed().panel(panel).rightCols(At.rows()).topRows(count).rowwise().squaredNorm();
      passage->carry(C_, panel, C_support, X.data());
    }
    P_.readRows(panel, columns_in, E.data());
    // Of columns of former panels the rows that are given away are written already.
    rows_in.of(panel,
               [&](Index row, Index i) { P_in.row(i).tail(n_in - i) = E.row(row).tail(n_in - i); });
    E += X.col(2) * in.g.transpose();
    rows_out.of(panel, [&](Index row, Index i) {
      X.row(row) = state.P.row(out[at(i)]);
      E.row(row) = in.X.col(out[at(i)]).transpose();
    });
    const Eigen::MatrixXd X_out = X(Eigen::all, out);
    P_.writeRows(panel, out_slots, X_out.data());
    auto C = C_.panel(panel);
    C(Eigen::all, to_state) = X(Eigen::all, from_state);
    C(Eigen::all, to_entering) = E;
    for (Index row = 0; row < kRows; ++row)
      if (const std::size_t r = at(panel * kRows + row); r >= rests_.size() || !rests_[r])
        C.row(row).setZero();
  }
  C_.setCols(n);
  P_.forgive(in.rows);
  P_.forgive(out_slots);
  x_(out_slots) = x_transported_(out_slots) = state.x(out);
  variance_(out_slots) = state.P.diagonal()(out);
  for (const Block& block : blocks_)
    x_.segment(block.offset, block.size()) =
        moved(block, step.middleRows(block.offset, block.size()));

  P_in.triangularView<Eigen::StrictlyLower>() = P_in.transpose();
  P_in += in.g * in.w.transpose() + in.w * in.g.transpose();
  next.P.resize(n, n);
  next.P(to_state, to_state) = state.P(from_state, from_state);
  next.P(to_entering, to_state) = in.X(Eigen::all, from_state);
  next.P(to_state, to_entering) = in.X(Eigen::all, from_state).transpose();
  next.P(to_entering, to_entering) = P_in;

  const auto middle = static_cast<std::ptrdiff_t>(blocks_.size());
  std::sort(leaving.begin(), leaving.end(), older);
  blocks_.insert(blocks_.end(), leaving.begin(), leaving.end());
  std::inplace_merge(blocks_.begin(), blocks_.begin() + middle, blocks_.end(), older);
  if (blocks_.empty()) {
    *this = RestingMap();
  } else {
    next.transfer = Transfer{Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                             Eigen::MatrixX3d::Zero(n, 3)};
    P_state_ = next.P;
  }
  state = std::move(next);
}

}  // namespace colonnade
