// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "se3.hpp"

namespace colonnade {

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// What a residual that fits nothing costs, of whatever size: it is one of something else.
constexpr double kOutlierCost = 4.0;

/// H dx = -g for the unknowns of an alignment: twist (6), gain and bias of the brightness.
struct NormalEquations {
  Matrix8 H = Matrix8::Zero();
  Vector8 g = Vector8::Zero();
  double cost = 0.0;        ///< sum of robust costs, none above kOutlierCost
  double sigma = 0.0;       ///< of a residual, as used for the weights, within bounds
  double full_sigma = 0.0;  ///< as estimated
  int count = 0;            ///< residuals
  int in_view = 0;          ///< points that were looked for, with those hidden or too far off
  /// Brightness: how much of the reference's gradient the current image shows at the same place:
  /// about 1 when aligned, less when blurred, 0 for a blank or wrong image.
  double gradient_agreement = 0.0;
};

/// One residual and its derivative.
struct ResidualRow {
  Eigen::Matrix<float, 8, 1> J;
  float r;
};

/// Of a Student distribution of 5 degrees of freedom, for r in units of its scale.
inline float studentWeight(float squared_r) { return 6.0f / (5.0f + squared_r); }

/// Weighs residuals by a Student distribution of 5 degrees of freedom (Kerl et al. 2013, "Robust
/// odometry estimation for RGB-D cameras", eq. 14) whose scale is 1.4826 times the median of |r|,
/// within [min_sigma, max_sigma]: a wrong pose must not turn everything into noise. `magnitudes`
/// holds every |r| and is reordered.
NormalEquations normalEquations(const std::vector<ResidualRow>& rows,
                                std::vector<float>& magnitudes, float min_sigma, float max_sigma);

/// Keeps of the twist's equations only what is really constrained: `feigned` is the information
/// that noise of the surface normals, or of brightness gradients, alone would add. Along a corridor
/// the normal matrix holds little else, and a point-to-plane fit slides there while its residual is
/// fine. Directions are the generalised eigenvectors of both matrices; below `ratio` times the
/// feigned information they fade out.
void suppressWeakDirections(const Matrix6& feigned, double ratio, NormalEquations& equations);

}  // namespace colonnade
