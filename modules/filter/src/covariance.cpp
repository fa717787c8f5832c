// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/covariance.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

/// Every direction of the state back into [-pi, pi].
void wrapDirections(State& state) {
  state.x(2) = wrapAngle(state.x(2));
  for (const Block& block : state.blocks) {
    const int direction = layoutOf(block.block_kind).direction;
    if (direction < 0) continue;
    double& angle = state.x(block.offset + direction);
    angle = wrapAngle(angle);
  }
}

/// x <- exp(xi) x: the whole world turned about its origin by dx's heading, with what the turn does
/// not explain, dx - G(x) dphi, spread over it. The first `fixed` entries after the robot's stay.
void retractInvariant(State& state, const Eigen::VectorXd& dx, Eigen::Index fixed) {
  const double turn = dx(2);
  const Eigen::VectorXd rest = dx - worldTurn(state) * turn;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(turn).toRotationMatrix();
  const Eigen::Matrix2d V = spreadOverTurn(turn);
  const auto move = [&](int offset, int size, BlockLayout layout) {
    const int point = offset + layout.point;
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    if (layout.point >= 0) p = R * state.x.segment<2>(point) + V * rest.segment<2>(point);
    state.x.segment(offset, size) += dx.segment(offset, size);
    if (layout.point >= 0) state.x.segment<2>(point) = p;
  };
  move(0, 3, kRobotLayout);
  for (const Block& block : state.blocks)
    if (block.offset >= 3 + fixed) move(block.offset, block.size(), layoutOf(block.block_kind));
}

void retract(State& state, const Eigen::VectorXd& dx, bool invariant, Eigen::Index fixed) {
  if (invariant)
    retractInvariant(state, dx, fixed);
  else
    state.x += dx;
  wrapDirections(state);
}

/// P + A B, which is symmetric, without the block of the `fixed` entries after the robot's, however
/// many these are. Written are the lower triangle, for mirrorLowerTriangle(), and some of the
/// upper.
void addBesideFixed(Eigen::MatrixXd& P, const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                    Eigen::Index fixed) {
  const Eigen::Index others = P.rows() - 3, own = others - fixed;
  P.leftCols(3).noalias() += A * B.leftCols(3);
  P.bottomRightCorner(own, others).noalias() += A.bottomRows(own) * B.rightCols(others);
}

/// P <- M P M^T with M = I + g e^T, e the heading: a symmetric change of rank two, since
/// P + g h^T + h g^T + v g g^T = P + g (h + v/2 g)^T + (h + v/2 g) g^T with h = P e, v = e^T P e.
void transport(Eigen::MatrixXd& P, const Eigen::VectorXd& g, Eigen::Index fixed) {
  const Eigen::VectorXd h = P.col(2) + 0.5 * P(2, 2) * g;
  if (fixed == 0) {
    P.selfadjointView<Eigen::Lower>().rankUpdate(g, h);
    return;
  }
  Eigen::MatrixX2d gh(P.rows(), 2), hg(P.rows(), 2);
  gh << g, h;
  hg << h, g;
  addBesideFixed(P, gh, hg.transpose(), fixed);
}

/// Guivant and Nebot 2001: what a correction with gain P H^T S^-1 does to the resting
/// part, whose points move by the displacement spread over the `turn`; and the transport of the
/// state's own rows by M = I + g e^T.
void carryCorrection(Transfer& transfer, const Eigen::MatrixXd& HPhi, const Eigen::MatrixXd& PHt,
                     const Eigen::LLT<Eigen::MatrixXd>& S, const Eigen::VectorXd& nu, double turn,
                     const Eigen::VectorXd& g) {
  const Eigen::MatrixXd SHPhi = S.solve(HPhi);
  transfer.Psi.noalias() += HPhi.transpose() * SHPhi;
  const Eigen::VectorXd step = SHPhi.transpose() * nu;
  const Eigen::Matrix2d V = spreadOverTurn(turn);
  transfer.theta += step * Eigen::RowVector3d(1.0, V(0, 0), V(1, 0));
  transfer.Phi.noalias() -= PHt * SHPhi;
  if (g.size() > 0) transfer.Phi += g * transfer.Phi.row(2).eval();
}

/// The upper triangle, but for the block of the fixed entries.
void mirrorLowerTriangle(Eigen::MatrixXd& P, Eigen::Index fixed) {
  for (Eigen::Index column = 1; column < P.cols(); ++column) {
    const Eigen::Index rows = column >= 3 && column < 3 + fixed ? 3 : column;
    P.col(column).head(rows) = P.row(column).head(rows).transpose();
  }
}

}  // namespace

void predictRobot(State& state, const Pose2& T_previous_robot, const Eigen::Matrix3d& Q) {
  Eigen::Matrix3d F;
  Eigen::Matrix3d G;
  const Pose2 pose = compose(state.T_world_robot(), T_previous_robot, &F, &G);
  state.x.head<3>() = pose.vector();
  const Eigen::Index rest = state.x.size() - 3;
  Eigen::MatrixXd& P = state.P;
  const Eigen::Matrix3d P_robot =
      F * P.topLeftCorner<3, 3>() * F.transpose() + G * Q * G.transpose();
  P.topLeftCorner<3, 3>() = 0.5 * (P_robot + P_robot.transpose());
  if (state.transfer)
    state.transfer->Phi.topRows<3>() = (F * state.transfer->Phi.topRows<3>()).eval();
  if (rest == 0) return;
  P.topRightCorner(3, rest) = (F * P.topRightCorner(3, rest)).eval();
  P.bottomLeftCorner(rest, 3) = P.topRightCorner(3, rest).transpose();
}

Eigen::MatrixXd timesTransposed(const Eigen::MatrixXd& P, const SparseJacobian& H) {
  Eigen::MatrixXd PHt = Eigen::MatrixXd::Zero(P.rows(), H.rows);
  for (const auto& part : H.parts)
    PHt.middleCols(part.row, part.H.rows()).noalias() +=
        P.middleCols(part.column, part.H.cols()) * part.H.transpose();
  return PHt;
}

Eigen::MatrixXd times(const SparseJacobian& H, const Eigen::MatrixXd& A) {
  Eigen::MatrixXd HA = Eigen::MatrixXd::Zero(H.rows, A.cols());
  for (const auto& part : H.parts)
    HA.middleRows(part.row, part.H.rows()).noalias() +=
        part.H * A.middleRows(part.column, part.H.cols());
  return HA;
}

Eigen::MatrixXd bothSides(const SparseJacobian& H, const Eigen::MatrixXd& P) {
  Eigen::MatrixXd HPHt = Eigen::MatrixXd::Zero(H.rows, H.rows);
  for (const auto& a : H.parts) {
    Eigen::MatrixXd PHt = Eigen::MatrixXd::Zero(a.H.cols(), H.rows);
    for (const auto& b : H.parts)
      PHt.middleCols(b.row, b.H.rows()) +=
          P.block(a.column, b.column, a.H.cols(), b.H.cols()).lazyProduct(b.H.transpose());
    HPHt.middleRows(a.row, a.H.rows()) += a.H.lazyProduct(PHt);
  }
  return HPHt;
}

bool correct(State& state, const SparseJacobian& H, const Eigen::VectorXd& nu,
             const Eigen::MatrixXd& R, bool invariant, Eigen::Index fixed) {
  const Eigen::MatrixXd PHt = timesTransposed(state.P, H);
  const Eigen::MatrixXd S = times(H, PHt) + R;
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) return false;
  Eigen::VectorXd dx = PHt * llt.solve(nu);
  dx.segment(3, fixed).setZero();
  if (!dx.allFinite()) return false;

  // W W^T = P H^T S^-1 H P, so that P loses a symmetric product: it cannot become unsymmetric.
  const Eigen::MatrixXd W = llt.matrixL().solve(PHt.transpose()).transpose();
  if (fixed == 0)
    state.P.selfadjointView<Eigen::Lower>().rankUpdate(W, -1.0);
  else
    addBesideFixed(state.P, -W, W.transpose(), fixed);
  mirrorLowerTriangle(state.P, fixed);

  const Eigen::VectorXd G_before = worldTurn(state);
  retract(state, dx, invariant, fixed);
  Eigen::VectorXd g;
  if (invariant) {
    g = worldTurn(state) - G_before;
    transport(state.P, g, fixed);
    mirrorLowerTriangle(state.P, fixed);
  }
  if (state.transfer)
    carryCorrection(*state.transfer, times(H, state.transfer->Phi), PHt, llt, nu,
                    invariant ? dx(2) : 0.0, g);
  return true;
}

void augment(State& state, Block block, const BlockVector& values, const SparseJacobian& J_state,
             const Eigen::MatrixXd& added_covariance) {
  const Eigen::Index n = state.x.size();
  const Eigen::Index k = values.size();
  const Eigen::MatrixXd PJt = timesTransposed(state.P, J_state);
  const Eigen::MatrixXd P_block = times(J_state, PJt) + added_covariance;
  state.x.conservativeResize(n + k);
  state.x.tail(k) = values;
  state.P.conservativeResize(n + k, n + k);
  state.P.topRightCorner(n, k) = PJt;
  state.P.bottomLeftCorner(k, n) = PJt.transpose();
  state.P.bottomRightCorner(k, k) = 0.5 * (P_block + P_block.transpose());
  if (state.transfer) {
    Eigen::MatrixXd& Phi = state.transfer->Phi;
    const Eigen::MatrixXd rows = times(J_state, Phi);
    Phi.conservativeResize(n + k, Eigen::NoChange);
    Phi.bottomRows(k) = rows;
  }
  block.offset = static_cast<int>(n);
  state.blocks.push_back(block);
}

void replaceBlock(State& state, LandmarkId id, BlockKind kind, const BlockVector& values,
                  const Eigen::MatrixXd& J) {
  Block* block = state.find(id);
  const Eigen::Index offset = block->offset;
  const Eigen::Index before = block->size();
  const Eigen::Index after = values.size();
  const Eigen::Index n = state.x.size();
  // T maps the old state to the new one: identity but for the block.
  Eigen::MatrixXd TP(n - before + after, n);
  TP << state.P.topRows(offset), J * state.P.middleRows(offset, before),
      state.P.bottomRows(n - offset - before);
  Eigen::MatrixXd P(TP.rows(), TP.rows());
  P << TP.leftCols(offset), TP.middleCols(offset, before) * J.transpose(),
      TP.rightCols(n - offset - before);
  Eigen::VectorXd x(TP.rows());
  x << state.x.head(offset), values, state.x.tail(n - offset - before);
  state.P = 0.5 * (P + P.transpose());
  state.x = std::move(x);
  if (state.transfer) {
    const Eigen::MatrixXd& Phi = state.transfer->Phi;
    Eigen::MatrixXd rows(TP.rows(), Phi.cols());
    rows << Phi.topRows(offset), J * Phi.middleRows(offset, before),
        Phi.bottomRows(n - offset - before);
    state.transfer->Phi = std::move(rows);
  }
  block->block_kind = kind;
  for (Block& other : state.blocks)
    if (other.offset > offset) other.offset += static_cast<int>(after - before);
}

void moveWorld(State& state, const Pose2& T_new_old) {
  const Eigen::Matrix2d R = T_new_old.rotation();
  const auto turn = [&](Eigen::Index offset) {
    state.P.middleRows<2>(offset) = (R * state.P.middleRows<2>(offset)).eval();
    state.P.middleCols<2>(offset) = (state.P.middleCols<2>(offset) * R.transpose()).eval();
  };
  const auto move = [&](int offset, BlockLayout layout) {
    if (layout.direction >= 0) state.x(offset + layout.direction) += T_new_old.phi;
    if (layout.point < 0) return;
    const int point = offset + layout.point;
    state.x.segment<2>(point) = transform(T_new_old, state.x.segment<2>(point));
    turn(point);
  };
  move(0, kRobotLayout);
  for (const Block& block : state.blocks) move(block.offset, layoutOf(block.block_kind));
  wrapDirections(state);
  state.P = (0.5 * (state.P + state.P.transpose())).eval();
}

void removeBlock(State& state, LandmarkId id) {
  const Block* block = state.find(id);
  const Eigen::Index offset = block->offset;
  const Eigen::Index size = block->size();
  const Eigen::Index tail = state.x.size() - offset - size;
  state.x.segment(offset, tail) = state.x.tail(tail).eval();
  state.x.conservativeResize(offset + tail);
  state.P.middleRows(offset, tail) = state.P.bottomRows(tail).eval();
  state.P.middleCols(offset, tail) = state.P.rightCols(tail).eval();
  state.P.conservativeResize(offset + tail, offset + tail);
  if (state.transfer) {
    Eigen::MatrixXd& Phi = state.transfer->Phi;
    Phi.middleRows(offset, tail) = Phi.bottomRows(tail).eval();
    Phi.conservativeResize(offset + tail, Eigen::NoChange);
  }
  if (state.sensor == id) state.sensor.reset();
  state.blocks.erase(state.blocks.begin() + (block - state.blocks.data()));
  for (Block& other : state.blocks)
    if (other.offset > offset) other.offset -= static_cast<int>(size);
}

}  // namespace colonnade
