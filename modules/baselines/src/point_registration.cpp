// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_registration.hpp"

#include <mrpt/poses/CPose3D.h>
#include <mrpt/tfest/se3.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <iostream>

namespace colonnade {
namespace {

/// MRPT says on std::cerr what it also returns.
class QuietCerr {
 public:
  QuietCerr() : former_(std::cerr.rdbuf(nullptr)) {}
  ~QuietCerr() {
    std::cerr.rdbuf(former_);
    std::cerr.clear();
  }
  QuietCerr(const QuietCerr&) = delete;
  QuietCerr& operator=(const QuietCerr&) = delete;

 private:
  std::streambuf* former_;
};

}  // namespace

std::optional<Eigen::Isometry3d> registerPoints(const std::vector<PointPair>& pairs) {
  constexpr std::size_t kSmallestSet = 3;
  if (pairs.size() < kSmallestSet) return std::nullopt;
  mrpt::tfest::TMatchingPairList matches;
  std::uint32_t index = 0;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3f a = pair.p_a.cast<float>();
    const Eigen::Vector3f b = pair.p_b.cast<float>();
    matches.emplace_back(index, index, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    ++index;
  }
  mrpt::tfest::TSE3RobustParams parameters;
  parameters.ransac_minSetSize = kSmallestSet;
  parameters.ransac_maxSetSizePct = 6.0 / static_cast<double>(pairs.size());
  mrpt::tfest::TSE3RobustResult result;
  try {
    const QuietCerr quiet;
    if (!mrpt::tfest::se3_l2_robust(matches, parameters, result)) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;  // too few pairs for its own assertions
  }
  if (!(std::abs(result.scale - 1.0) < 0.1)) return std::nullopt;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  T_a_b.matrix() = mrpt::poses::CPose3D(result.transformation)
                       .getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>()
                       .asEigen();
  if (!T_a_b.matrix().allFinite()) return std::nullopt;
  return T_a_b;
}

}  // namespace colonnade
