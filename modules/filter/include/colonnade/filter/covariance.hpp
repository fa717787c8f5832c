// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "colonnade/filter/state.hpp"

namespace colonnade {

/// The only functions that write x and P of a State.

/// EKF prediction of the robot rows: x_r <- x_r + u, P <- F P F^T + G Q G^T. Q in the former
/// robot's axes. The rest of the state does not move.
void predictRobot(State& state, const Pose2& T_previous_robot, const Eigen::Matrix3d& Q);

/// A stacked derivative in the state: the few blocks of it that are not zero.
struct SparseJacobian {
  struct Part {
    Eigen::Index row = 0;     ///< first row of the part
    Eigen::Index column = 0;  ///< first column: an offset in the state vector
    Eigen::MatrixXd H;
  };
  explicit SparseJacobian(Eigen::Index row_count = 0) : rows(row_count) {}
  SparseJacobian& add(Eigen::Index row, Eigen::Index column, Eigen::MatrixXd H) {
    parts.push_back({row, column, std::move(H)});
    return *this;
  }
  Eigen::Index rows = 0;
  std::vector<Part> parts;
};

/// P H^T (n x m) without touching the zeros of H.
Eigen::MatrixXd timesTransposed(const Eigen::MatrixXd& P, const SparseJacobian& H);
/// H P H^T; reads of P only what H speaks of.
Eigen::MatrixXd bothSides(const SparseJacobian& H, const Eigen::MatrixXd& P);
/// H A (m x k) for a dense A of n rows.
Eigen::MatrixXd times(const SparseJacobian& H, const Eigen::MatrixXd& A);

/// One EKF correction with innovation nu and its covariance S = H P H^T + R. Returns false, and
/// leaves the state as it was, when S is not positive definite or the result is not finite.
/// invariant: the correction turns the whole world about its origin by its heading part, and P is
/// carried to the new estimate by M = I + (G(x+) - G(x-)) e_heading^T, which keeps the filter from
/// gaining information about directions nobody observes (Barrau and Bonnabel, arXiv 1510.06263).
/// fixed: the first entries after the robot's three that keep their value and covariance, while
/// what is not known of them still counts (Schmidt's consider filter; Jazwinski, Stochastic
/// Processes and Filtering Theory, section 8.4).
bool correct(State& state, const SparseJacobian& H, const Eigen::VectorXd& nu,
             const Eigen::MatrixXd& R, bool invariant, Eigen::Index fixed = 0);

/// A new block y = f(x, w): its values, the sparse derivative in x and the covariance of what w
/// adds. The block keeps every correlation with the state.
void augment(State& state, Block block, const BlockVector& values, const SparseJacobian& J_state,
             const Eigen::MatrixXd& added_covariance);

/// Replaces a block by a function of itself: values and J = d(new)/d(old).
void replaceBlock(State& state, LandmarkId id, BlockKind kind, const BlockVector& values,
                  const Eigen::MatrixXd& J);

/// The same state in another world: places, directions and their covariance. Nothing may rest.
void moveWorld(State& state, const Pose2& T_new_old);

/// Takes a block out of the state: the others keep their marginal.
void removeBlock(State& state, LandmarkId id);

}  // namespace colonnade
