// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
//
// IncrementalSmoother: between the drive and the tree, the terms as they are linearised.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/incremental_smoother.hpp"
#include "drive_terms.hpp"

namespace colonnade {
namespace {

/// A term is linearised again when it is off by more than this from what its linearisation says, in
/// sigmas, or its derivatives by more than this share of them.
constexpr double kOff = 0.01;

/// U with U^T U = information.
template <class Matrix>
Matrix rootOf(const Matrix& information) {
  return Eigen::LLT<Matrix>(information).matrixU();
}

}  // namespace

IncrementalSmoother::Moved IncrementalSmoother::moved(int variable) const {
  const std::size_t i = number_[static_cast<std::size_t>(variable)];
  if (variable == sensor_) return drive_.sensor->errors.vector();
  if (is_point_[static_cast<std::size_t>(variable)])
    return drive_.points_world[i] - point_bases_[i];
  return pose_moved_[i];
}

void IncrementalSmoother::place(int variable, const Moved& moved) {
  const std::size_t i = number_[static_cast<std::size_t>(variable)];
  if (variable == sensor_) {
    drive_.sensor->errors = SensorErrors::of(moved);
  } else if (moved.size() == 2) {
    drive_.points_world[i] = point_bases_[i] + moved;
  } else {
    pose_moved_[i] = moved;
    const Eigen::Vector3d pose = pose_bases_[i] + pose_moved_[i];
    drive_.T_world_robot[i] = {pose(0), pose(1), wrapAngle(pose(2))};
  }
}

void IncrementalSmoother::bring(int variable) {
  if (!std::binary_search(behind_.begin(), behind_.end(), variable))
    place(variable, tree_.x(variable));
}

LinearFactor IncrementalSmoother::motionFactor(std::size_t pose) const {
  const MotionTerm term = motionTerm(drive_, pose);
  const Eigen::Matrix3d root = rootOf(term.information);
  const int before = poses_[pose - 1], after = poses_[pose];
  LinearFactor factor{{before, after}, Eigen::MatrixXd(3, 7)};
  const Eigen::Vector3d r =
      term.residual - term.J_before * moved(before) - term.J_after * moved(after);
  factor.J_r << root * term.J_before, root * term.J_after, root * r;
  return factor;
}

LinearFactor IncrementalSmoother::sightingFactor(std::size_t number) const {
  const Drive::Sighting& sighting = drive_.sightings[number];
  const SightingTerm term = sightingTerm(drive_, sighting);
  const double distance2 = term.residual.dot(term.information * term.residual);
  const MeasurementCovariance root =
      std::sqrt(huberWeight(distance2, term.residual.size())) * rootOf(term.information);
  LinearFactor factor;
  Eigen::MatrixXd& J_r = factor.J_r;
  J_r.resize(term.residual.size(), 3 + 2 + SensorErrors::kSize + 1);
  MeasurementVector r = term.residual;
  Eigen::Index column = 0;
  const auto add = [&](int variable, const auto& J) {
    factor.variables.push_back(variable);
    r -= J.lazyProduct(moved(variable));
    J_r.middleCols(column, J.cols()) = root.lazyProduct(J);
    column += J.cols();
  };
  add(poses_[sighting.pose], term.J_pose);
  add(points_[sighting.point], term.J_point);
  if (sensor_) add(*sensor_, term.J_sensor);
  J_r.col(column) = root * r;
  J_r.conservativeResize(Eigen::NoChange, column + 1);
  return factor;
}

LinearFactor IncrementalSmoother::depthFactor(std::size_t number) const {
  const Drive::Depth& depth = drive_.depths[number];
  const DepthTerm term = depthTerm(drive_, depth);
  const double root = std::sqrt(term.information);
  const int pose = poses_[depth.pose], point = points_[depth.point];
  LinearFactor factor{{pose, point}, Eigen::MatrixXd(1, 6)};
  const double r = term.residual - term.J_point.dot(moved(point)) - term.J_pose.dot(moved(pose));
  factor.J_r << root * term.J_pose, root * term.J_point, root * r;
  return factor;
}

void IncrementalSmoother::set(int& factor, LinearFactor to) {
  if (factor < 0)
    factor = tree_.addFactor(std::move(to));
  else
    tree_.setFactor(factor, std::move(to));
}

bool IncrementalSmoother::relinearise(int factor, LinearFactor now) {
  const Eigen::MatrixXd &before = tree_.factor(factor).J_r, &J_r = now.J_r;
  const Eigen::Index n = J_r.cols() - 1;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 10>;
  const Small dJ = J_r.leftCols(n) - before.leftCols(n);
  // Both linearisations where the drive is.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> r = J_r.col(n) - before.col(n);
  Eigen::Index column = 0;
  for (const int v : now.variables) {
    const Moved x = moved(v);
    r += dJ.middleCols(column, x.size()).lazyProduct(x);
    column += x.size();
  }
  if (r.squaredNorm() < kOff * kOff &&
      dJ.squaredNorm() < kOff * kOff * J_r.leftCols(n).squaredNorm())
    return false;
  tree_.setFactor(factor, std::move(now));
  return true;
}

}  // namespace colonnade
