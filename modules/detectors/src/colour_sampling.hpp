// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "colonnade/detectors/refined_line.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Mean colour (B, G, R; gray thrice without colour) of a narrow strip beside a line between two of
/// its places, on the side of growing (+1) or falling (-1) u (steep lines) or v (flat lines).
Eigen::Vector3f meanColourBeside(const Frame& frame, const RefinedLine& line, double begin,
                                 double end, int side);

}  // namespace colonnade
