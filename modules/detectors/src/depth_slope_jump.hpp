// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "depth_slope_corners.hpp"
#include "slice_surfaces.hpp"

namespace colonnade {

/// The corner where the nearer of two neighbouring surfaces ends before the farther one, if there
/// is such a step in depth.
std::optional<SliceCorner> jumpBetween(const SliceSurfaces& surfaces, const InverseLine& left,
                                       const InverseLine& right);

}  // namespace colonnade
