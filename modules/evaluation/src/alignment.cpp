// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "alignment.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "colonnade/base/error.hpp"
#include "colonnade/base/pose2.hpp"

namespace colonnade {
namespace {

/// Weight of one unit of orientation against one square metre of position spread.
constexpr double kOrientationWeight = 1e-8;

using PoseOf = Eigen::Isometry3d PosePair::*;

Eigen::Vector3d meanPosition(const std::vector<PosePair>& pairs, PoseOf pose) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& pair : pairs) sum += (pair.*pose).translation();
  return sum / static_cast<double>(pairs.size());
}

/// Sum over the pairs of truth times estimate', positions about their means: the matrix whose
/// nearest rotation is the answer (Umeyama 1991, equations 38 and 40).
Eigen::Matrix3d correlation(const std::vector<PosePair>& pairs, const Eigen::Vector3d& mean_truth,
                            const Eigen::Vector3d& mean_estimate) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& pair : pairs) {
    sum += (pair.T_truth_body.translation() - mean_truth) *
           (pair.T_estimate_body.translation() - mean_estimate).transpose();
    sum +=
        kOrientationWeight * pair.T_truth_body.linear() * pair.T_estimate_body.linear().transpose();
  }
  return sum;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// The rotation about z that maximises trace(R' matrix): tan(yaw) = (m10 - m01) / (m00 + m11).
Eigen::Matrix3d nearestYaw(const Eigen::Matrix3d& matrix) {
  const double yaw = std::atan2(matrix(1, 0) - matrix(0, 1), matrix(0, 0) + matrix(1, 1));
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

const char* name(Alignment alignment) {
  switch (alignment) {
    case Alignment::kNone:
      return "none";
    case Alignment::kSe2:
      return "se2";
    case Alignment::kSe3:
      return "se3";
  }
  return "unknown";
}

Alignment alignmentOfName(const std::string& text) {
  for (const auto alignment : {Alignment::kNone, Alignment::kSe2, Alignment::kSe3})
    if (text == name(alignment)) return alignment;
  throw Error("\"" + text + "\" is no alignment; choose none, se2 or se3", ExitCode::kUsage);
}

Eigen::Isometry3d fitAlignment(const std::vector<PosePair>& pairs, Alignment alignment) {
  Eigen::Isometry3d T_truth_estimate = Eigen::Isometry3d::Identity();
  if (alignment == Alignment::kNone) return T_truth_estimate;
  const Eigen::Vector3d mean_truth = meanPosition(pairs, &PosePair::T_truth_body);
  const Eigen::Vector3d mean_estimate = meanPosition(pairs, &PosePair::T_estimate_body);
  const Eigen::Matrix3d matrix = correlation(pairs, mean_truth, mean_estimate);
  const bool planar = alignment == Alignment::kSe2;
  T_truth_estimate.linear() = planar ? nearestYaw(matrix) : nearestRotation(matrix);
  T_truth_estimate.translation() = mean_truth - T_truth_estimate.linear() * mean_estimate;
  if (planar) T_truth_estimate.translation().z() = 0.0;
  return T_truth_estimate;
}

}  // namespace colonnade
