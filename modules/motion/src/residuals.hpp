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
  std::vector<float> magnitudes;
};

/// Brightness of the reference's points against the current image, bilinear; the gradient is the
/// mean of both images' (as in ESM, Malis 2004). Points hidden in the current depth are left out;
/// an uncertain depth takes weight where it would move the point along its gradient. What noise of
/// the gradients alone would tell is left out below `weak_direction_ratio` times it (0: nothing
/// is).
NormalEquations photometricEquations(const std::vector<PhotometricPoint>& points,
                                     const PyramidLevel& current, const AlignmentState& state,
                                     double weak_direction_ratio, ResidualBuffer& buffer);

/// |residual| of each point, -1 for those out of view.
std::vector<float> brightnessResiduals(const std::vector<PhotometricPoint>& points,
                                       const PyramidLevel& current, const AlignmentState& state);

/// Distance of the current depth from the reference's surfaces along their normals, each pixel
/// associated by projection (Blais and Levine 1995), within `gate_m` or 4 sigma.
NormalEquations surfaceEquations(const std::vector<SurfacePoint>& points,
                                 const PyramidLevel& current, const AlignmentState& state,
                                 float gate_m, double weak_direction_ratio, ResidualBuffer& buffer);

}  // namespace colonnade
