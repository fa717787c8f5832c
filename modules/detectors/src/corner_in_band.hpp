// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "depth_slope_corners.hpp"

namespace colonnade {

/// Whether a band of heights shows the corner: nothing where it does not measure both sides.
std::optional<bool> isSeenIn(const InverseColumns& band, const InverseColumns& columns,
                             const SliceCorner& corner, double focal_px);

}  // namespace colonnade
