// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "normal_equations.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace colonnade {
namespace {

float robustSigma(std::vector<float>& magnitudes) {
  if (magnitudes.empty()) return 0.0f;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return 1.4826f * *middle;
}

}  // namespace

NormalEquations normalEquations(const std::vector<ResidualRow>& rows,
                                std::vector<float>& magnitudes, float min_sigma, float max_sigma) {
  constexpr float kFreedom = 5.0f;
  constexpr std::size_t kRun = 128;  // summed in single precision
  const float estimated_sigma = robustSigma(magnitudes);
  const float sigma = std::clamp(estimated_sigma, min_sigma, max_sigma);
  const float inverse_variance = 1.0f / (sigma * sigma);
  constexpr float kMost = static_cast<float>(2.0 * kOutlierCost) / (kFreedom + 1.0f);
  NormalEquations equations;
  for (std::size_t begin = 0; begin < rows.size(); begin += kRun) {
    Eigen::Matrix<float, 8, 8> H = Eigen::Matrix<float, 8, 8>::Zero();
    Eigen::Matrix<float, 8, 1> g = Eigen::Matrix<float, 8, 1>::Zero();
    float cost = 0.0f;
    const std::size_t end = std::min(begin + kRun, rows.size());
    for (std::size_t i = begin; i < end; ++i) {
      const ResidualRow& row = rows[i];
      const float squared = row.r * row.r * inverse_variance;
      const float weight = studentWeight(squared) * inverse_variance;
      const Eigen::Matrix<float, 8, 1> weighted = weight * row.J;
      H.noalias() += weighted * row.J.transpose();
      g.noalias() += weighted * row.r;
      cost += std::min(std::log1p(squared / kFreedom), kMost);
    }
    equations.H += H.cast<double>();
    equations.g += g.cast<double>();
    equations.cost += 0.5 * static_cast<double>((kFreedom + 1.0f) * cost);
  }
  equations.count = static_cast<int>(rows.size());
  equations.sigma = static_cast<double>(sigma);
  equations.full_sigma = static_cast<double>(std::max(estimated_sigma, sigma));
  return equations;
}

void suppressWeakDirections(const Matrix6& feigned, double ratio, NormalEquations& equations) {
  if (equations.count == 0 || !(ratio > 0.0)) return;
  const Matrix6 H = equations.H.topLeftCorner<6, 6>();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> eigen(H, feigned);
  if (eigen.info() != Eigen::Success || !eigen.eigenvalues().allFinite()) {
    equations = NormalEquations{};
    return;
  }
  Vector6 keep;
  for (int i = 0; i < 6; ++i) {
    const double excess = std::max(0.0, eigen.eigenvalues()(i)) / ratio;
    keep(i) = std::pow(excess, 4) / (1.0 + std::pow(excess, 4));
  }
  // V^T feigned V = I, so (feigned V)^T is the inverse of V.
  const Matrix6& V = eigen.eigenvectors();
  const Matrix6 W = feigned * V;
  equations.H.topLeftCorner<6, 6>() =
      W * keep.cwiseProduct(eigen.eigenvalues()).asDiagonal() * W.transpose();
  const Eigen::Matrix<double, 6, 2> across = equations.H.topRightCorner<6, 2>();
  equations.H.topRightCorner<6, 2>() = W * keep.asDiagonal() * (V.transpose() * across);
  equations.H.bottomLeftCorner<2, 6>() = equations.H.topRightCorner<6, 2>().transpose();
  equations.g.head<6>() = W * keep.cwiseProduct(V.transpose() * equations.g.head<6>());
}

}  // namespace colonnade
