// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/filter/smoother.hpp"
#include "colonnade/slam/resumption.hpp"

namespace colonnade {

/// What a loaded map says beforehand of a drive to be smoothed. Smoothed with are those of its
/// landmarks the drive saw; the others follow by what they have in common with them.
class KnownMap {
 public:
  /// now: the map at the end of the drive; seen: which of its landmarks were.
  KnownMap(const Resumption& from, const LandmarkMap& now, const std::vector<bool>& seen);

  /// Not where the drive saw more than 500 of its landmarks, or some that are no points.
  bool isUsable() const { return usable_; }
  /// Indices of the map: seen ones first, then the new ones.
  const std::vector<std::size_t>& kept() const { return kept_; }

  /// Of the pose after the first motion, and of the landmarks seen.
  Drive::Prior prior(const Drive::Motion& first) const;

  /// All places and their covariance (none: empty), from those kept. A new landmark none of whose
  /// readings was `used` stays as it is.
  void spread(const std::vector<Eigen::Vector2d>& points_kept, const Eigen::MatrixXd& C_kept,
              const std::vector<double>& used, LandmarkMap& map, Eigen::MatrixXd& C) const;

 private:
  const Resumption& from_;
  std::vector<std::size_t> kept_, unseen_;
  std::vector<Eigen::Index> seen_rows_, unseen_rows_;  ///< of the loaded state
  Eigen::MatrixXd P_seen_;
  Eigen::LLT<Eigen::MatrixXd> seen_llt_;
  bool usable_ = true;
};

/// The covariance of a place that has nothing in common with the others.
void standAlone(Eigen::MatrixXd& C, std::size_t i, const Eigen::Matrix2d& covariance);

}  // namespace colonnade
