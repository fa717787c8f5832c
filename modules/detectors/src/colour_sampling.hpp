// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/detectors/refined_line.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Mean colours (B, G, R; gray thrice without colour) of narrow strips beside a line.
struct BesideColours {
  Eigen::Vector3f before = Eigen::Vector3f::Zero();  ///< where u (steep lines) or v (flat) is less
  Eigen::Vector3f behind = Eigen::Vector3f::Zero();
};
/// Between two places of the line.
BesideColours coloursBeside(const Frame& frame, const RefinedLine& line, double begin, double end);

}  // namespace colonnade
