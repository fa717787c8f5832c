// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "colonnade/filter/measurement_models.hpp"
#include "colonnade/filter/smoother.hpp"
#include "drive_terms.hpp"

namespace colonnade {

/// H dx = -g of a drive's least squares about the estimate it holds, and the cost there: the sum of
/// squared Mahalanobis distances, for sightings in Huber's loss. dx has three entries for each
/// pose, but for the first without a prior, xi of Exp(xi) T_world_robot, two for each point,
/// metres added to it, and last five for a sensor's errors. With xi on the world's side a stretch
/// of the way turns as a whole without any change to the motions along it, however stiff those are
/// and however far it turns.
class NormalEquations {
 public:
  explicit NormalEquations(const Drive& drive);

  Eigen::Index poseAt(std::size_t pose) const {
    return 3 * (static_cast<Eigen::Index>(pose) - held_);
  }
  Eigen::Index pointAt(std::size_t point) const {
    return 3 * (poses_ - held_) + 2 * static_cast<Eigen::Index>(point);
  }
  Eigen::Index sensorAt() const { return pointAt(points_); }
  std::size_t firstFreePose() const { return static_cast<std::size_t>(held_); }
  /// Its lower triangle, which is what Eigen's factorisations read.
  Eigen::SparseMatrix<double> H() const;
  const Eigen::VectorXd& g() const { return g_; }
  double cost() const { return cost_; }

 private:
  /// At most as large as what a sensor is off by: kept without allocation.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                              SensorErrors::kSize, SensorErrors::kSize>;

  void addPrior(const Drive& drive, const Drive::Prior& prior);
  void addMotion(const Drive& drive, std::size_t pose);
  void addDepth(const Drive& drive, const Drive::Depth& depth);
  void addPairOfOne(const Drive& drive, const Drive::Pair& pair);
  void addSensor(const Drive::Sensor& sensor);
  void addSighting(const Drive& drive, const Drive::Sighting& sighting);
  void addBlock(Eigen::Index row, Eigen::Index column,
                const Eigen::Ref<const Eigen::MatrixXd>& block);
  /// Of a and b, wherever that is below the diagonal.
  void addMixed(Eigen::Index a, Eigen::Index b, const Small& block);
  void addPair(Eigen::Index a, Eigen::Index b, const Small& J_a, const Small& J_b,
               const Small& weight, const Small& residual);

  Eigen::Index held_;  ///< poses that do not move: the first one, or none
  Eigen::Index poses_;
  std::size_t points_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd g_;
  double cost_ = 0.0;
};

/// How (x, y, phi) of a pose moves with xi.
Eigen::Matrix3d liftOf(const Pose2& T_world_robot);

/// The drive's estimate moved by dx.
void move(Drive& drive, const NormalEquations& at, const Eigen::VectorXd& dx);

}  // namespace colonnade
