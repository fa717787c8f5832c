// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "surfaces.hpp"

namespace colonnade {

/// A line in space as the image has it, walked in steps of a pixel.
struct ImageLine {
  Eigen::Vector2d from, to;         ///< pixels, within the image
  double inverse_from, inverse_to;  ///< inverse depth of the two ends; affine between them
  int steps = 1;

  Eigen::Vector2d at(int step) const { return from + (to - from) * step / steps; }
  double inverseAt(int step) const {
    return inverse_from + (inverse_to - inverse_from) * step / steps;
  }
};

/// The part of a line (its ends in the optical frame) that falls into the image, farther away than
/// 0.1 m; nothing when there is none.
std::optional<ImageLine> projectedLine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const PinholeCamera& camera);

/// For every step of a line: does it lie on a surface that is seen there, give or take a pixel?
std::vector<bool> unhiddenSteps(const ImageLine& line, const Surfaces& surfaces);

}  // namespace colonnade
