// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "two_poses.hpp"

namespace colonnade {

Way wayFromClone(const State& state, LandmarkId clone) {
  const int at = state.find(clone)->offset;
  Eigen::Matrix<double, 6, 6> P;
  P.topLeftCorner<3, 3>() = state.P.block<3, 3>(at, at).selfadjointView<Eigen::Lower>();
  P.bottomRightCorner<3, 3>() = state.P.topLeftCorner<3, 3>().selfadjointView<Eigen::Lower>();
  P.topRightCorner<3, 3>() = state.P.block<3, 3>(at, 0);
  P.bottomLeftCorner<3, 3>() = P.topRightCorner<3, 3>().transpose();

  // T_clone_robot = (R_c^T (t_r - t_c), phi_r - phi_c), differentiated in both poses.
  const Pose2 T_world_clone{state.x(at), state.x(at + 1), state.x(at + 2)};
  const Pose2 T_world_robot = state.T_world_robot();
  Way way;
  way.T_clone_robot = T_world_clone.inverse() * T_world_robot;
  const Eigen::Matrix2d R_clone_world = T_world_clone.rotation().transpose();
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.topLeftCorner<2, 2>() = -R_clone_world;
  J(0, 2) = way.T_clone_robot.y;
  J(1, 2) = -way.T_clone_robot.x;
  J(2, 2) = -1.0;
  J.block<2, 2>(0, 3) = R_clone_world;
  J(2, 5) = 1.0;
  way.covariance = J * P * J.transpose();
  return way;
}

}  // namespace colonnade
