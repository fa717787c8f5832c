// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "normal_equations.hpp"
#include "rgbd_pyramid.hpp"

namespace colonnade {

/// The unknowns of an alignment. The twist acts on the left of T_current_reference; the affine
/// change of brightness is I_current = (1 + gain) I_reference + bias.
struct AlignmentState {
  Eigen::Isometry3d T_current_reference = Eigen::Isometry3d::Identity();
  double gain = 0.0;
  double bias = 0.0;
};

/// Room that the residual functions use again and again.
struct ResidualBuffer {
  std::vector<ResidualRow> rows;
  std::vector<float> by_falloff;  ///< of brightness: derivative of each row's residual
  std::vector<float> magnitudes;
};

/// What a lens loses off its axis: brightness is 1 - falloff tan^2 of that on the axis, tan of the
/// angle between. By nature (cos^4) the falloff is 2, of a plain camera about 0.4.
struct FalloffEquation {
  double H = 0.0;  ///< second derivative of the cost by the falloff
  double g = 0.0;  ///< its first
  Vector8 mixed = Vector8::Zero();
};

/// Of the rows that `photometricEquations` left in the buffer, with its sigma.
FalloffEquation falloffEquation(const ResidualBuffer& buffer, double sigma);

/// Brightness of the reference's points against the current image, bilinear; the gradient is the
/// mean of both images' (as in ESM, Malis 2004). Points hidden in the current depth are left out;
/// an uncertain depth takes weight where it would move the point along its gradient. What noise of
/// the gradients alone would tell is left out below `weak_direction_ratio` times it (0: nothing
/// is).
NormalEquations photometricEquations(const std::vector<PhotometricPoint>& points,
                                     const PyramidLevel& current, const AlignmentState& state,
                                     double lens_falloff, double weak_direction_ratio,
                                     ResidualBuffer& buffer);

/// |residual| of each point, -1 for those out of view.
std::vector<float> brightnessResiduals(const std::vector<PhotometricPoint>& points,
                                       const PyramidLevel& current, const AlignmentState& state);

/// Standard deviation of brightness from such residuals, at least one level: from their lower
/// quartile, so that a part of them may be of something else.
float brightnessNoise(std::vector<float> residuals);

/// Distance of the current depth from the reference's surfaces along their normals, each pixel
/// associated by projection (Blais and Levine 1995), within `gate_m` or 4 sigma.
NormalEquations surfaceEquations(const std::vector<SurfacePoint>& points,
                                 const PyramidLevel& current, const AlignmentState& state,
                                 float gate_m, double weak_direction_ratio, ResidualBuffer& buffer);

}  // namespace colonnade
